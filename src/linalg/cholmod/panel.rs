//! Dense kernels on one panel of `L`: a packed lower triangle (column by column) and a rectangle
//! (`rows x columns`, column-major).
//!
//! | kernel | does |
//! |---|---|
//! | [`solve_lower`] | `x = L^-1 x` |
//! | [`solve_upper`] | `x = L^-T x` |
//! | [`multiply_lower`] | `x = L x` |
//! | [`multiply`] | `y = A x` |
//! | [`subtract_transposed`] | `x -= A' y` |
//!
//! They are written so that the compiler vectorises them: four columns at a time share the loads and
//! stores of the long vector, and sums run in lanes of their own.

/// Partial sums of one dot product: enough to hide the latency of an addition.
const LANES: usize = 4;

/// `x = L^-1 x`.
pub(super) fn solve_lower(triangle: &[f64], x: &mut [f64]) {
    let mut rest = triangle;
    for j in 0..x.len() {
        let (column, tail) = rest.split_at(x.len() - j);
        rest = tail;
        let value = x[j] / column[0];
        x[j] = value;
        for (x, &l) in x[j + 1..].iter_mut().zip(&column[1..]) {
            *x -= l * value;
        }
    }
}

/// `x = L^-T x`.
pub(super) fn solve_upper(triangle: &[f64], x: &mut [f64]) {
    let mut rest = triangle;
    for j in (0..x.len()).rev() {
        let (head, column) = rest.split_at(rest.len() - (x.len() - j));
        rest = head;
        x[j] = (x[j] - dot(&column[1..], &x[j + 1..])) / column[0];
    }
}

/// `x = L x`.
pub(super) fn multiply_lower(triangle: &[f64], x: &mut [f64]) {
    let mut rest = triangle;
    for j in (0..x.len()).rev() {
        let (head, column) = rest.split_at(rest.len() - (x.len() - j));
        rest = head;
        let value = x[j];
        x[j] = value * column[0];
        for (x, &l) in x[j + 1..].iter_mut().zip(&column[1..]) {
            *x += l * value;
        }
    }
}

/// `y = A x` with `A` of `y.len() x x.len()`.
pub(super) fn multiply(rectangle: &[f64], x: &[f64], y: &mut [f64]) {
    let m = y.len();
    y.fill(0.0);
    if m == 0 {
        return;
    }
    let fours = rectangle.chunks_exact(4 * m);
    let ones = fours.remainder();
    for (block, x) in fours.zip(x.chunks_exact(4)) {
        let (a, block) = block.split_at(m);
        let (b, block) = block.split_at(m);
        let (c, d) = block.split_at(m);
        for ((((y, a), b), c), d) in y.iter_mut().zip(a).zip(b).zip(c).zip(d) {
            *y += (a * x[0] + b * x[1]) + (c * x[2] + d * x[3]);
        }
    }
    let rest = x.chunks_exact(4).remainder();
    for (column, &x) in ones.chunks_exact(m).zip(rest) {
        for (y, a) in y.iter_mut().zip(column) {
            *y += a * x;
        }
    }
}

/// `x -= A' y` with `A` of `y.len() x x.len()`.
pub(super) fn subtract_transposed(rectangle: &[f64], y: &[f64], x: &mut [f64]) {
    let m = y.len();
    if m == 0 {
        return;
    }
    let fours = rectangle.chunks_exact(4 * m);
    let ones = fours.remainder();
    let mut targets = x.chunks_exact_mut(4);
    for (block, x) in fours.zip(&mut targets) {
        let (a, block) = block.split_at(m);
        let (b, block) = block.split_at(m);
        let (c, d) = block.split_at(m);
        let mut sums = [[0.0; LANES]; 4];
        let whole = m - m % LANES;
        for i in (0..whole).step_by(LANES) {
            let y: &[f64] = &y[i..i + LANES];
            for (sum, column) in sums.iter_mut().zip([a, b, c, d]) {
                let column = &column[i..i + LANES];
                for lane in 0..LANES {
                    sum[lane] += column[lane] * y[lane];
                }
            }
        }
        for (x, (sum, column)) in x.iter_mut().zip(sums.iter().zip([a, b, c, d])) {
            let mut total = (sum[0] + sum[1]) + (sum[2] + sum[3]);
            for i in whole..m {
                total += column[i] * y[i];
            }
            *x -= total;
        }
    }
    for (column, x) in ones.chunks_exact(m).zip(targets.into_remainder()) {
        *x -= dot(column, y);
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    let (a, b) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let mut total = 0.0;
    for (a, b) in a.remainder().iter().zip(b.remainder()) {
        total += a * b;
    }
    for (a, b) in a.zip(b) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    total + ((sums[0] + sums[1]) + (sums[2] + sums[3]))
}
