//! Tests with bodies that are coupled by contact alone.

use super::*;

/// Two bodies whose freedoms alternate: contact freedoms of one body are not coupled with those of
/// the other.
#[test]
fn bodies_that_only_touch_have_blocks_of_their_own() {
    let grid = Grid::<2>::new([12, 7], Support::Bottom);
    let one = grid.stiffness(|_| 1.0);
    let mut both = sprs::TriMatI::<f64, i64>::new((2 * grid.n, 2 * grid.n));
    for (value, (row, column)) in one.iter() {
        for body in 0..2 {
            let at = |freedom: i64| 2 * freedom as usize + body;
            both.add_triplet(at(row), at(column), (1 + body) as f64 * value);
        }
    }
    let top = grid.freedoms(1..2, |[_, y]| y == 7);
    let below = grid.freedoms(0..2, |[x, y]| y > 3 && y < 7 && x > 2);
    let twice = |freedoms: &[usize]| freedoms.iter().flat_map(|f| [2 * f, 2 * f + 1]).collect();
    let partition = Partition {
        n: 2 * grid.n,
        zone: twice(&below),
        contact: twice(&top),
    };
    let shift = (0..2 * top.len()).map(|k| k as f64).collect();
    let sample = Sample::new(both.to_csc(), partition, shift);
    for Way { name, condense, .. } in ways() {
        let condensed = condense(&sample.matrix, &sample.partition, &sample.shift).expect(name);
        assert_agrees(&sample, &*condensed);
        let stiffness = condensed.contact_stiffness();
        let mut freedoms: Vec<&[usize]> = stiffness.blocks().map(|b| &b.freedoms[..]).collect();
        freedoms.sort();
        let of_body = |body: usize| -> Vec<usize> { (body..2 * top.len()).step_by(2).collect() };
        assert_eq!(freedoms, [of_body(0), of_body(1)]);
        let x = nalgebra::DMatrix::from_fn(2 * top.len(), 3, |i, j| (i + j) as f64);
        let round_off = 2.0 * top.len() as f64 * f64::EPSILON;
        let whole = stiffness.dense();
        let difference = stiffness.times(&x) - &whole * &x;
        assert!(difference.norm() <= round_off * whole.norm() * x.norm());
    }
}
