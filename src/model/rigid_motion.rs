//! Rigid motions of bodies, and the work of forces on them.

/// Work that counts as zero, relative to the sum of the sizes of its terms.
const NO_WORK: f64 = 1e-9;

/// A rigid motion that supports leave free: a null vector of the stiffness. It is known exactly,
/// whereas a factorisation would find it only up to round-off of the body's stiffness.
#[derive(Debug, Clone, PartialEq)]
pub struct RigidMotion {
    /// Number of the part of the model that moves.
    pub part: usize,
    /// Displacement of the freedoms that move (free freedom, value), ascending. Rotations are
    /// scaled to the body's size: values are of order 1.
    pub values: Vec<(u32, f64)>,
    /// Weights that give the share of the motion in any displacement `u`, measured on the part's
    /// far boundary: `sum weight u[freedom]`.
    pub in_far_boundary: Vec<(u32, f64)>,
}

impl RigidMotion {
    /// Displacement of a free freedom in this motion.
    pub fn at(&self, freedom: usize) -> f64 {
        let place = self
            .values
            .binary_search_by_key(&(freedom as u32), |&(f, _)| f);
        place.map_or(0.0, |at| self.values[at].1)
    }

    /// Work of forces on free freedoms (freedom, force) on the motion.
    pub fn work_of<'f>(&self, forces: impl Iterator<Item = &'f (usize, f64)>) -> Work {
        let works = forces.map(|&(freedom, force)| force * self.at(freedom));
        works.fold(Work::default(), |sum, work| sum.and(1.0, work, work.abs()))
    }
}

/// Work on a rigid motion: the sum of its terms, and the sum of their sizes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Work {
    sum: f64,
    size: f64,
}

impl Work {
    /// Adds `share` of another work with the given sum and size.
    fn and(self, share: f64, sum: f64, size: f64) -> Self {
        Work {
            sum: self.sum + share * sum,
            size: self.size + share.abs() * size,
        }
    }

    /// Work on a motion that is a combination of others.
    pub fn combined(shares: impl Iterator<Item = (f64, Work)>) -> Self {
        shares.fold(Work::default(), |all, (share, own)| {
            all.and(share, own.sum, own.size)
        })
    }

    /// Value of the work; zero if it is only the round-off of its terms.
    pub fn done(self) -> f64 {
        if self.sum.abs() > NO_WORK * self.size {
            self.sum
        } else {
            0.0
        }
    }
}
