//! Stiffness matrix of an element for an isotropic law.
//!
//! With the gradients `g_k` of the shape functions, their trace `t_k = g_k + N_k/r e_r` (the hoop
//! term only if axisymmetric) and the mean dilatation `m_k` of the element (B-bar)
//!
//! ```text
//! K_ij = sum_g w (lambda t_i t_j' + mu (g_j g_i' + g_i.g_j I) + 2 mu N_i N_j/r^2 e_r e_r')
//! B-bar: lambda - kappa in place of lambda, and V kappa m_i m_j'     kappa bulk modulus, V volume
//! ```
//!
//! If the shear is taken from the centre ([`super`]), the shear's share of the second term is
//! `mu s_i s_j'`, where `s_k` is the contribution of the displacements of node k to the shear.

use super::gradients::{Gradients, Lanes, dot, of_nodes, sum};
use crate::material::Lame;

impl<const D: usize, const S: usize, const P: usize, const N: usize> Gradients<D, S, P, N> {
    /// Writes `K_e` for an elastic law into `out`, as a packed lower triangle ([`packed`]).
    pub(crate) fn stiffness_into(&self, law: &Lame, out: &mut [f64]) {
        of_nodes!(self.n_nodes(), self, stiffness_of, law, out);
    }

    /// Mean dilatation for a unit displacement of each node along each axis, `int tr B / V`.
    #[inline]
    pub(super) fn mean_dilatation(&self) -> [[f64; D]; N] {
        of_nodes!(self.n_nodes(), self, padded_mean,)
    }

    fn padded_mean<const K: usize>(&self) -> [[f64; D]; N] {
        let mut out = [[0.0; D]; N];
        let traces = self.traces(&self.of_functions::<K>());
        out[..K].copy_from_slice(&self.means(&traces));
        out
    }

    /// Means `m_k` of the traces over the element's volume.
    fn means<const K: usize>(&self, traces: &[[Lanes<P>; D]; K]) -> [[f64; D]; K] {
        let volume: f64 = self.weights.iter().sum();
        std::array::from_fn(|k| std::array::from_fn(|d| dot(&traces[k][d], &self.weights) / volume))
    }

    /// Traces `t_k` of the strains for unit displacements of the nodes.
    fn traces<const K: usize>(&self, gradients: &[[Lanes<P>; D]; K]) -> [[Lanes<P>; D]; K] {
        let mut out = *gradients;
        if let Some(per_radius) = &self.per_radius {
            for (out, values) in out.iter_mut().zip(&self.table.values) {
                for g in 0..P {
                    out[0][g] += per_radius[g] * values[g];
                }
            }
        }
        out
    }

    fn stiffness_of<const K: usize>(&self, law: &Lame, out: &mut [f64]) {
        let gradients = self.of_functions::<K>();
        let traces = self.traces(&gradients);
        let bulk = if self.has_mean { law.bulk() } else { 0.0 };
        let weighted = |by: f64| self.weights.map(|w| w * by);
        let (lambda, mu) = (weighted(law.lambda - bulk), weighted(law.mu));
        for i in 0..K {
            for j in 0..=i {
                let of_trace: [Lanes<P>; D] = traces[j].map(|t| product(&lambda, &t));
                let of_shear: [Lanes<P>; D] = gradients[j].map(|t| product(&mu, &t));
                let mut along = [0.0; P];
                for (gradient, of_shear) in gradients[i].iter().zip(&of_shear) {
                    for g in 0..P {
                        along[g] += gradient[g] * of_shear[g];
                    }
                }
                for a in 0..D {
                    for b in 0..if i == j { a + 1 } else { D } {
                        let mut terms = if a == b { along } else { [0.0; P] };
                        for g in 0..P {
                            terms[g] += traces[i][a][g] * of_trace[b][g]
                                + gradients[i][b][g] * of_shear[a][g];
                        }
                        out[packed(D * i + a, D * j + b)] = sum(&terms);
                    }
                }
            }
        }
        if let Some(per_radius) = &self.per_radius {
            self.add_hoop::<K>(per_radius, &mu, out);
        }
        if self.shear.is_some() {
            self.exchange_shear(&gradients, &mu, out);
        }
        if self.has_mean {
            let volume: f64 = self.weights.iter().sum();
            let mean = self.means(&traces);
            let mean = mean.as_flattened();
            for row in 0..D * K {
                for column in 0..=row {
                    out[packed(row, column)] += volume * bulk * mean[row] * mean[column];
                }
            }
        }
    }

    fn add_hoop<const K: usize>(&self, per_radius: &Lanes<P>, mu: &Lanes<P>, out: &mut [f64]) {
        for i in 0..K {
            for j in 0..=i {
                let (a, b) = (&self.table.values[i], &self.table.values[j]);
                let terms: Lanes<P> = std::array::from_fn(|g| {
                    2.0 * mu[g] * (per_radius[g] * a[g]) * (per_radius[g] * b[g])
                });
                out[packed(D * i, D * j)] += sum(&terms);
            }
        }
    }

    /// Replaces the shear at the points by the shear from the centre.
    fn exchange_shear<const K: usize>(
        &self,
        gradients: &[[Lanes<P>; D]; K],
        mu: &Lanes<P>,
        out: &mut [f64],
    ) {
        let Some(shear) = &self.shear else { return };
        let center: [f64; K] = self.at_center(shear);
        let of_center = |k: usize| {
            let factors = &shear.factors;
            let along_x = factors.map(|factor| factor * center[k]);
            [along_x, product(factors, &gradients[k][0])]
        };
        for i in 0..K {
            let (new, old) = (of_center(i), [gradients[i][1], gradients[i][0]]);
            for j in 0..=i {
                let (new_j, old_j) = (of_center(j), [gradients[j][1], gradients[j][0]]);
                for a in 0..2 {
                    for b in 0..if i == j { a + 1 } else { 2 } {
                        let terms: Lanes<P> = std::array::from_fn(|g| {
                            mu[g] * (new[a][g] * new_j[b][g] - old[a][g] * old_j[b][g])
                        });
                        out[packed(D * i + a, D * j + b)] += sum(&terms);
                    }
                }
            }
        }
    }
}

#[inline]
fn product<const P: usize>(a: &Lanes<P>, b: &Lanes<P>) -> Lanes<P> {
    std::array::from_fn(|g| a[g] * b[g])
}

/// Index of entry (i, j) in the packed lower triangle of a symmetric matrix.
pub fn packed(i: usize, j: usize) -> usize {
    let row = i.max(j);
    row * (row + 1) / 2 + i.min(j)
}
