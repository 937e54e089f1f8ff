//! What the constrained order costs and what the trailing solves gain, on elastic bodies on regular
//! grids that are held at the bottom and pressed at the middle of the top.
//!
//! `cargo bench --bench trailing` takes plane bodies of 180 k and 980 k freedoms; `-- small` only
//! the first, `-- solid` a solid one; `-- orders` compares the methods of ordering instead.

use brinell::linalg::cholmod::{
    Method, blas_name, cholmod_version, condense, condense_with_method, factor_unconstrained,
    predict_with_method,
};
use brinell::linalg::{Partition, SymmetricCsc};
use std::time::Instant;

// Shared with the unit tests, which use more of it.
#[allow(dead_code)]
#[path = "../src/linalg/tests/matrices.rs"]
mod matrices;
use matrices::{Grid, Support};

fn main() -> Result<(), brinell::Error> {
    let arguments: Vec<String> = std::env::args().collect();
    let given = |name: &str| arguments.iter().any(|a| a == name);
    println!("CHOLMOD {}, {}", cholmod_version(), blas_name());
    let run = if given("orders") { orders } else { trailing };
    if given("solid") {
        return run(&Body::new([36, 36, 36]));
    }
    run(&Body::new([300, 300]))?;
    if given("small") {
        return Ok(());
    }
    run(&Body::new([700, 700]))
}

/// A body and how its freedoms are grouped for a zone of a given share.
struct Body {
    matrix: SymmetricCsc,
    /// For each share of the zone in per cent: the partition.
    partitions: Vec<(usize, Partition)>,
}

impl Body {
    fn new<const D: usize>(elements: [usize; D]) -> Self {
        let grid = Grid::new(elements, Support::Bottom);
        let top = elements[D - 1];
        // Distance from the middle of the top, as a share of the body, in the largest direction.
        let depth = |place: [usize; D]| {
            (0..D)
                .map(|d| match d + 1 == D {
                    true => (top - place[d]) as f64 / top as f64,
                    false => (2.0 * place[d] as f64 / elements[d] as f64 - 1.0).abs(),
                })
                .fold(0.0, f64::max)
        };
        let contact = grid.freedoms(D - 1..D, |p| p[D - 1] == top && depth(p) <= 0.2);
        let partitions = [1, 3, 10, 30]
            .into_iter()
            .map(|share| {
                let radius = (share as f64 / 100.0).powf(1.0 / D as f64);
                let mut zone = grid.freedoms(0..D, |p| depth(p) <= radius);
                zone.retain(|freedom| contact.binary_search(freedom).is_err());
                let partition = Partition {
                    n: grid.n,
                    zone,
                    contact: contact.clone(),
                };
                (share, partition)
            })
            .collect();
        Body {
            matrix: grid.stiffness(|_| 1.0),
            partitions,
        }
    }
}

/// Seconds and result of the fastest of several calls.
fn timed<T>(repeat: usize, mut call: impl FnMut() -> T) -> (f64, T) {
    let mut best: Option<(f64, T)> = None;
    for _ in 0..repeat {
        let start = Instant::now();
        let result = call();
        let seconds = start.elapsed().as_secs_f64();
        if best.as_ref().is_none_or(|(least, _)| seconds < *least) {
            best = Some((seconds, result));
        }
    }
    best.expect("called at least once")
}

fn trailing(body: &Body) -> Result<(), brinell::Error> {
    let n = body.matrix.rows();
    let (bare, cost) = timed(2, || factor_unconstrained(&body.matrix));
    let cost = cost?;
    println!(
        "\n{n} freedoms; CHOLMOD by itself: analysis and factor {bare:.2} s, {:.1} M nonzeros, \
         {:.1} Gflop",
        cost.factor_nonzeros / 1e6,
        cost.flops / 1e9
    );
    println!(
        "zone   n_z     n_c  order s  all s  C s    nnz(L) M  Gflop  trailing  half ms  trailing \
         ms  GB/s"
    );
    for (share, partition) in &body.partitions {
        let (ordering, _) = timed(1, || {
            predict_with_method(&body.matrix, partition, Method::Automatic)
        });
        let (all, condensed) = timed(1, || condense(&body.matrix, partition, &[]));
        let condensed = condensed?;
        let cost = condensed.cost();
        let (stiffness, _) = timed(2, || condensed.contact_stiffness());
        let (n_zone, n_contact) = (partition.zone.len(), partition.contact.len());
        let load = vec![1.0; n_zone];
        let (mut zone, mut contact) = (load.clone(), vec![0.0; n_contact]);
        let displacement = vec![0.0; n_contact];
        let (solve, _) = timed(20, || {
            zone.copy_from_slice(&load);
            contact.fill(0.0);
            condensed.eliminate_zone(&mut zone, &mut contact);
            condensed.recover_zone(&mut zone, &displacement);
        });
        let reduced = condensed.reduce_load(&vec![1e-3; n])?;
        let (half, u) = timed(3, || {
            condensed.recover_all(&reduced, &vec![0.0; n_zone], &displacement)
        });
        u?;
        // Each solve runs through the zone's columns twice.
        let rate = 16.0 * (cost.trailing_nonzeros - 0.5 * (n_contact as f64).powi(2)) / solve / 1e9;
        println!(
            "{share:3} % {n_zone:7} {n_contact:5} {ordering:7.2} {all:7.2} {stiffness:6.3} {:8.1} \
             {:8.1} {:7.1} % {:8.1} {:10.2} {rate:8.1}",
            cost.factor_nonzeros / 1e6,
            cost.flops / 1e9,
            100.0 * cost.trailing_nonzeros / cost.factor_nonzeros,
            1e3 * half,
            1e3 * solve,
        );
    }
    Ok(())
}

fn orders(body: &Body) -> Result<(), brinell::Error> {
    println!("\n{} freedoms", body.matrix.rows());
    println!(
        "zone   method          order s  nnz(L) M    Gflop  Gflop / M entries  trailing M  factor s"
    );
    for (share, partition) in &body.partitions {
        for method in [Method::MinimumDegree, Method::Dissection] {
            let (ordering, cost) =
                timed(1, || predict_with_method(&body.matrix, partition, method));
            let cost = cost?;
            let (all, condensed) = timed(1, || {
                condense_with_method(&body.matrix, partition, &[], method)
            });
            condensed?;
            println!(
                "{share:3} %  {:14} {ordering:8.2} {:9.1} {:8.1} {:18.1} {:11.2} {:9.2}",
                format!("{method:?}"),
                cost.factor_nonzeros / 1e6,
                cost.flops / 1e9,
                cost.flops / body.matrix.nnz() as f64 / 1e3,
                cost.trailing_nonzeros / 1e6,
                all - ordering,
            );
        }
    }
    Ok(())
}
