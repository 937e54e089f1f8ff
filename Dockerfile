# docker build -t brinell . && docker run --rm -v "$PWD:/work" brinell run scene.toml
FROM rust:1-bookworm AS build
RUN apt-get update && apt-get install -y --no-install-recommends \
        libsuitesparse-dev libopenblas-dev libclang-dev \
    && rm -rf /var/lib/apt/lists/*
WORKDIR /brinell
COPY . .
RUN cargo build --release --locked --bin brinell

FROM debian:bookworm-slim
RUN apt-get update && apt-get install -y --no-install-recommends \
        libcholmod3 libklu1 libcamd2 libsuitesparseconfig5 libopenblas0-pthread libgomp1 \
    && rm -rf /var/lib/apt/lists/*
COPY --from=build /brinell/target/release/brinell /usr/local/bin/
WORKDIR /work
ENTRYPOINT ["brinell"]
