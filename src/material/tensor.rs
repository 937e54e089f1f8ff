//! Algebra of tensors as vectors `[xx, yy, zz, xy | yz, zx]`.

/// Converts a tensor to another number of components; missing components become zero.
pub(crate) fn resized<const S: usize, const T: usize>(tensor: &[f64; S]) -> [f64; T] {
    std::array::from_fn(|i| tensor.get(i).copied().unwrap_or(0.0))
}

/// Returns `a x + b y`. A loop, because arrays made by closures are slow without inlining.
#[inline]
pub(super) fn sum<const S: usize>(a: f64, x: &[f64; S], b: f64, y: &[f64; S]) -> [f64; S] {
    let mut out = [0.0; S];
    for k in 0..S {
        out[k] = a * x[k] + b * y[k];
    }
    out
}

/// Converts a strain with engineering shear to tensor components.
#[inline]
pub(super) fn tensor_of<const S: usize>(strain: &[f64; S]) -> [f64; S] {
    std::array::from_fn(|k| if k < 3 { strain[k] } else { 0.5 * strain[k] })
}

/// Double contraction `a:b` of two tensors.
#[inline]
pub(super) fn double_dot<const S: usize>(a: &[f64; S], b: &[f64; S]) -> f64 {
    let product = |k: usize| a[k] * b[k];
    let normal: f64 = (0..3).map(product).sum();
    let shear: f64 = (3..S).map(product).sum();
    normal + 2.0 * shear
}

/// Von Mises stress `sqrt(3/2 s:s)` of the deviator `s`.
#[inline]
pub fn von_mises<const S: usize>(stress: &[f64; S]) -> f64 {
    let (x, y, z) = (stress[0], stress[1], stress[2]);
    let shear: f64 = stress[3..].iter().map(|t| t * t).sum();
    (0.5 * ((x - y).powi(2) + (y - z).powi(2) + (z - x).powi(2)) + 3.0 * shear).sqrt()
}

/// Product `3/2 s:t` of the deviators of two stresses, which is the square of the von Mises stress
/// if they are equal.
#[inline]
pub(super) fn von_mises_product<const S: usize>(a: &[f64; S], b: &[f64; S]) -> f64 {
    let difference = |i: usize, j: usize| (a[i] - a[j]) * (b[i] - b[j]);
    let shear: f64 = (3..S).map(|k| a[k] * b[k]).sum();
    0.5 * (difference(0, 1) + difference(1, 2) + difference(2, 0)) + 3.0 * shear
}
