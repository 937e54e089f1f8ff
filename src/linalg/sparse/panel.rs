//! Dense kernels on one panel of `L`: a lower triangle and a rectangle below it.
//!
//! | kernel | does |
//! |---|---|
//! | [`solve_lower`] | `x = L^-1 x` |
//! | [`solve_upper`] | `x = L^-T x` |
//! | [`multiply_lower`] | `x = L x` |
//! | [`multiply`] | `y = A x` |
//! | [`subtract_transposed`] | `x -= A' y` |
//!
//! Both parts are cut into strips of [`STRIP`] columns. A strip of the rectangle is stored in tiles
//! of [`TILE`] rows, column by column within a tile. A strip of the triangle is a packed triangle
//! of its own, followed by the tiles below it. Thus four columns share the loads and stores of the
//! long vector, only every fourth column waits for those before it, and the memory is read in one
//! stream in either direction of the solve.

use std::ops::Range;

/// Number of columns of a strip; the last strip of a panel may have fewer.
const STRIP: usize = 4;

/// Number of rows of a tile, of which a column fills a cache line; the last tile of a strip may
/// have fewer.
const TILE: usize = 8;

/// Number of partial sums of one dot product.
const LANES: usize = 4;

/// Splits `width` columns into strips.
fn strips(width: usize) -> impl DoubleEndedIterator<Item = Range<usize>> {
    (0..width.div_ceil(STRIP)).map(move |k| STRIP * k..(STRIP * (k + 1)).min(width))
}

/// Number of values of a triangle of `width` columns.
pub(crate) fn triangle_len(width: usize) -> usize {
    width * (width + 1) / 2
}

/// Appends the lower triangle of `width` columns to `out`; `column(k)` starts at its diagonal.
pub(crate) fn store_triangle<'a>(
    width: usize,
    column: impl Fn(usize) -> &'a [f64],
    out: &mut Vec<f64>,
) {
    for strip in strips(width) {
        for k in strip.clone() {
            out.extend_from_slice(&column(k)[..strip.end - k]);
        }
        store_strip(
            width - strip.end,
            strip.clone(),
            |k| &column(k)[strip.end - k..],
            out,
        );
    }
}

/// Appends the rectangle of `width` columns with `rows` rows to `out`.
pub(crate) fn store_rectangle<'a>(
    rows: usize,
    width: usize,
    column: impl Fn(usize) -> &'a [f64],
    out: &mut Vec<f64>,
) {
    for strip in strips(width) {
        store_strip(rows, strip, &column, out);
    }
}

fn store_strip<'a>(
    rows: usize,
    strip: Range<usize>,
    column: impl Fn(usize) -> &'a [f64],
    out: &mut Vec<f64>,
) {
    for top in (0..rows).step_by(TILE) {
        for k in strip.clone() {
            let rest = &column(k)[top..rows];
            match rest.first_chunk::<TILE>() {
                Some(tile) => out.extend_from_slice(tile),
                None => out.extend_from_slice(rest),
            }
        }
    }
}

/// Reads the lower triangle of `width` columns and calls `put(row, column, value)`.
pub(crate) fn read_triangle(
    width: usize,
    triangle: &[f64],
    mut put: impl FnMut(usize, usize, f64),
) {
    let mut values = triangle.iter();
    for strip in strips(width) {
        for k in strip.clone() {
            (k..strip.end)
                .zip(&mut values)
                .for_each(|(row, value)| put(row, k, *value));
        }
        read_strip(strip.end..width, strip, &mut values, &mut put);
    }
}

/// Reads the rectangle of `width` columns with `rows` rows and calls `put(row, column, value)`.
pub(crate) fn read_rectangle(
    rows: usize,
    width: usize,
    rectangle: &[f64],
    mut put: impl FnMut(usize, usize, f64),
) {
    let mut values = rectangle.iter();
    for strip in strips(width) {
        read_strip(0..rows, strip, &mut values, &mut put);
    }
}

fn read_strip(
    rows: Range<usize>,
    strip: Range<usize>,
    values: &mut std::slice::Iter<f64>,
    put: &mut impl FnMut(usize, usize, f64),
) {
    for top in rows.clone().step_by(TILE) {
        for k in strip.clone() {
            (top..rows.end.min(top + TILE))
                .zip(&mut *values)
                .for_each(|(row, value)| put(row, k, *value));
        }
    }
}

/// Adds `y += A x` for one strip of `A`.
#[inline(always)]
fn add_strip(strip: &[f64], x: &[f64], y: &mut [f64]) {
    let whole = y.len() - y.len() % TILE;
    let (y, y_end) = y.split_at_mut(whole);
    let (strip, end) = strip.split_at(x.len() * whole);
    if let &[x0, x1, x2, x3] = x {
        for (tile, y) in strip
            .chunks_exact(STRIP * TILE)
            .zip(y.chunks_exact_mut(TILE))
        {
            let (a, tile) = tile.split_at(TILE);
            let (b, tile) = tile.split_at(TILE);
            let (c, d) = tile.split_at(TILE);
            for i in 0..TILE {
                y[i] += (a[i] * x0 + b[i] * x1) + (c[i] * x2 + d[i] * x3);
            }
        }
    } else {
        for (tile, y) in strip
            .chunks_exact(x.len() * TILE)
            .zip(y.chunks_exact_mut(TILE))
        {
            for (column, x) in tile.chunks_exact(TILE).zip(x) {
                for i in 0..TILE {
                    y[i] += column[i] * x;
                }
            }
        }
    }
    if !y_end.is_empty() {
        for (column, x) in end.chunks_exact(y_end.len()).zip(x) {
            for (y, a) in y_end.iter_mut().zip(column) {
                *y += a * x;
            }
        }
    }
}

/// Subtracts `x -= A' y` for one strip of `A`.
#[inline(always)]
fn subtract_strip_transposed(strip: &[f64], y: &[f64], x: &mut [f64]) {
    let whole = y.len() - y.len() % TILE;
    let (y, y_end) = y.split_at(whole);
    let (strip, end) = strip.split_at(x.len() * whole);
    let mut sums = [[0.0; LANES]; STRIP];
    if x.len() == STRIP {
        // From the bottom up: in the triangle of a panel the values at the top become known last.
        for (tile, y) in strip
            .chunks_exact(STRIP * TILE)
            .zip(y.chunks_exact(TILE))
            .rev()
        {
            for half in (0..TILE).step_by(LANES) {
                for (k, sum) in sums.iter_mut().enumerate() {
                    for lane in 0..LANES {
                        sum[lane] += tile[k * TILE + half + lane] * y[half + lane];
                    }
                }
            }
        }
    } else {
        for (tile, y) in strip.chunks_exact(x.len() * TILE).zip(y.chunks_exact(TILE)) {
            for (column, sum) in tile.chunks_exact(TILE).zip(&mut sums) {
                for i in 0..TILE {
                    sum[i % LANES] += column[i] * y[i];
                }
            }
        }
    }
    for (k, (x, sum)) in x.iter_mut().zip(&sums).enumerate() {
        let column = &end[k * y_end.len()..(k + 1) * y_end.len()];
        let tail: f64 = column.iter().zip(y_end).map(|(a, y)| a * y).sum();
        *x -= ((sum[0] + sum[1]) + (sum[2] + sum[3])) + tail;
    }
}

/// Solves `x = L^-1 x` for the packed triangle of one strip.
#[inline(always)]
fn solve_corner(corner: &[f64], x: &mut [f64]) {
    if let (&mut [x0, x1, x2, x3], &[l00, l10, l20, l30, l11, l21, l31, l22, l32, l33]) =
        (&mut *x, corner)
    {
        // The reciprocals do not depend on x.
        let [r0, r1, r2, r3] = [1.0 / l00, 1.0 / l11, 1.0 / l22, 1.0 / l33];
        let x0 = x0 * r0;
        let x1 = (x1 - l10 * x0) * r1;
        let x2 = ((x2 - l20 * x0) - l21 * x1) * r2;
        let x3 = (((x3 - l30 * x0) - l31 * x1) - l32 * x2) * r3;
        x.copy_from_slice(&[x0, x1, x2, x3]);
        return;
    }
    let mut rest = corner;
    for j in 0..x.len() {
        let (column, next) = rest.split_at(x.len() - j);
        rest = next;
        x[j] /= column[0];
        for i in 1..column.len() {
            x[j + i] -= column[i] * x[j];
        }
    }
}

/// Solves `x = L^-T x` for the packed triangle of one strip.
#[inline(always)]
fn solve_corner_transposed(corner: &[f64], x: &mut [f64]) {
    if let (&mut [x0, x1, x2, x3], &[l00, l10, l20, l30, l11, l21, l31, l22, l32, l33]) =
        (&mut *x, corner)
    {
        let [r0, r1, r2, r3] = [1.0 / l00, 1.0 / l11, 1.0 / l22, 1.0 / l33];
        let x3 = x3 * r3;
        let x2 = (x2 - l32 * x3) * r2;
        let x1 = ((x1 - l31 * x3) - l21 * x2) * r1;
        let x0 = (((x0 - l30 * x3) - l20 * x2) - l10 * x1) * r0;
        x.copy_from_slice(&[x0, x1, x2, x3]);
        return;
    }
    let mut rest = corner;
    for j in (0..x.len()).rev() {
        let (head, column) = rest.split_at(rest.len() - (x.len() - j));
        rest = head;
        for i in 1..column.len() {
            x[j] -= column[i] * x[j + i];
        }
        x[j] /= column[0];
    }
}

#[inline(always)]
fn solve_lower_by_strips(triangle: &[f64], x: &mut [f64]) {
    let mut rest = triangle;
    for strip in strips(x.len()) {
        let (own, below) = x[strip.start..].split_at_mut(strip.len());
        let (corner, tiles) = rest.split_at(triangle_len(own.len()));
        let (tiles, next) = tiles.split_at(own.len() * below.len());
        rest = next;
        solve_corner(corner, own);
        let mut negative = [0.0; STRIP];
        for (negative, x) in negative.iter_mut().zip(&*own) {
            *negative = -x;
        }
        add_strip(tiles, &negative[..own.len()], below);
    }
}

#[inline(always)]
fn solve_upper_by_strips(triangle: &[f64], x: &mut [f64]) {
    let mut rest = triangle;
    for strip in strips(x.len()).rev() {
        let (own, below) = x[strip.start..].split_at_mut(strip.len());
        let (head, tiles) = rest.split_at(rest.len() - own.len() * below.len());
        let (head, corner) = head.split_at(head.len() - triangle_len(own.len()));
        rest = head;
        subtract_strip_transposed(tiles, below, own);
        solve_corner_transposed(corner, own);
    }
}

/// Multiplies by a lower triangle: `x = L x`.
pub(crate) fn multiply_lower(triangle: &[f64], x: &mut [f64]) {
    let mut rest = triangle;
    for strip in strips(x.len()).rev() {
        let (own, below) = x[strip.start..].split_at_mut(strip.len());
        let (head, tiles) = rest.split_at(rest.len() - own.len() * below.len());
        let (head, mut corner) = head.split_at(head.len() - triangle_len(own.len()));
        rest = head;
        add_strip(tiles, own, below);
        for j in (0..own.len()).rev() {
            let (head, column) = corner.split_at(corner.len() - (own.len() - j));
            corner = head;
            for i in 1..column.len() {
                own[j + i] += column[i] * own[j];
            }
            own[j] *= column[0];
        }
    }
}

#[inline(always)]
fn multiply_by_strips(rectangle: &[f64], x: &[f64], y: &mut [f64]) {
    y.fill(0.0);
    let mut rest = rectangle;
    for x in x.chunks(STRIP) {
        let (strip, next) = rest.split_at(x.len() * y.len());
        rest = next;
        add_strip(strip, x, y);
    }
}

#[inline(always)]
fn subtract_transposed_by_strips(rectangle: &[f64], y: &[f64], x: &mut [f64]) {
    // From the last strip to the first, in the direction in which a backward substitution reads the
    // memory.
    let mut rest = rectangle;
    for strip in strips(x.len()).rev() {
        let x = &mut x[strip];
        let (head, strip) = rest.split_at(rest.len() - x.len() * y.len());
        rest = head;
        subtract_strip_transposed(strip, y, x);
    }
}

/// Compiles a kernel twice, for any processor and for one with wider vectors, and chooses at run
/// time. The second version has the same operations in the same order (no fused ones), so both give
/// the same bits.
macro_rules! for_this_processor {
    ($(#[$doc:meta])* $name:ident, $wide:ident, $kernel:ident, ($($arg:ident: $type:ty),*)) => {
        $(#[$doc])*
        pub(crate) fn $name($($arg: $type),*) {
            #[cfg(target_arch = "x86_64")]
            if std::arch::is_x86_feature_detected!("avx2") {
                // SAFETY: the processor has the feature that the function was compiled for.
                return unsafe { $wide($($arg),*) };
            }
            $kernel($($arg),*);
        }

        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = "avx2")]
        fn $wide($($arg: $type),*) {
            $kernel($($arg),*);
        }
    };
}

for_this_processor!(
    /// Solves with a lower triangle: `x = L^-1 x`.
    solve_lower, solve_lower_avx2, solve_lower_by_strips, (triangle: &[f64], x: &mut [f64])
);
for_this_processor!(
    /// Solves with the transpose of a lower triangle: `x = L^-T x`.
    solve_upper, solve_upper_avx2, solve_upper_by_strips, (triangle: &[f64], x: &mut [f64])
);
for_this_processor!(
    /// Multiplies `y = A x` with `A` of size `y.len() x x.len()`.
    multiply, multiply_avx2, multiply_by_strips, (rectangle: &[f64], x: &[f64], y: &mut [f64])
);
for_this_processor!(
    /// Subtracts `x -= A' y` with `A` of size `y.len() x x.len()`.
    subtract_transposed,
    subtract_transposed_avx2,
    subtract_transposed_by_strips,
    (rectangle: &[f64], y: &[f64], x: &mut [f64])
);
