//! Check whether OpenBLAS uses the vector instructions of the processor.
//!
//! OpenBLAS chooses its kernels by the processor model when it is loaded. A release that is older
//! than the processor does not know the model and uses kernels for an old one, with a half or a
//! quarter of the speed. The environment variable `OPENBLAS_CORETYPE`, which OpenBLAS reads when it
//! is loaded, selects other kernels. A program can therefore restart with the variable set
//! ([`better_kernels`]); a library can only warn.

use super::blas;
use std::sync::Once;

/// Environment variable that selects OpenBLAS' kernels when a process starts.
pub const KERNEL_SETTING: &str = "OPENBLAS_CORETYPE";

/// Vector instructions, in ascending order of speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Vectors {
    /// SSE, vectors of 128 bits.
    Bits128,
    /// AVX, vectors of 256 bits, with separate multiplication and addition.
    Bits256,
    /// AVX2 and FMA, vectors of 256 bits, with fused multiplication and addition.
    Fused256,
    /// AVX-512 with its subsets F, CD, BW, DQ and VL.
    Fused512,
}

impl Vectors {
    /// Vector instructions of the OpenBLAS kernels called `name` (`driver/others/dynamic.c`);
    /// `None` for a name that is not known here, such as one of a later release.
    fn of_kernels(name: &str) -> Option<Self> {
        match name {
            "Katmai" | "Coppermine" | "Northwood" | "Prescott" | "Banias" | "Atom" | "Core2"
            | "Penryn" | "Dunnington" | "Nehalem" | "Athlon" | "Opteron" | "Opteron_SSE3"
            | "Barcelona" | "Bobcat" | "Nano" => Some(Vectors::Bits128),
            "Sandybridge" | "Bulldozer" | "Piledriver" | "Steamroller" => Some(Vectors::Bits256),
            "Excavator" | "Haswell" | "Zen" => Some(Vectors::Fused256),
            "SkylakeX" | "Cooperlake" | "SapphireRapids" => Some(Vectors::Fused512),
            _ => None,
        }
    }

    /// Vector instructions of this processor, as far as the operating system lets programs use
    /// them.
    #[cfg(target_arch = "x86_64")]
    fn of_processor() -> Option<Self> {
        let has_512 = is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512cd")
            && is_x86_feature_detected!("avx512bw")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512vl");
        Some(if has_512 {
            Vectors::Fused512
        } else if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            Vectors::Fused256
        } else if is_x86_feature_detected!("avx") {
            Vectors::Bits256
        } else {
            Vectors::Bits128
        })
    }

    #[cfg(not(target_arch = "x86_64"))]
    fn of_processor() -> Option<Self> {
        None
    }

    /// Kernels for these instructions that every OpenBLAS with a choice of kernels has.
    fn kernels(self) -> &'static str {
        match self {
            Vectors::Bits128 => "Prescott",
            Vectors::Bits256 => "Sandybridge",
            Vectors::Fused256 => "Haswell",
            Vectors::Fused512 => "SkylakeX",
        }
    }
}

/// Kernels that use more instructions of the `processor` than the kernels in use; `None` if there
/// are none, or if the name of the kernels in use is not known.
fn better(kernels: &str, processor: Vectors) -> Option<&'static str> {
    (Vectors::of_kernels(kernels)? < processor).then(|| processor.kernels())
}

/// Value of `OPENBLAS_CORETYPE` ([`KERNEL_SETTING`]) with which this process would compute faster.
/// `None` if OpenBLAS uses the full instructions of the processor, if it has no choice of kernels,
/// or if the variable is already set.
pub fn better_kernels() -> Option<&'static str> {
    let is_told = std::env::var_os(KERNEL_SETTING).is_some();
    if is_told || !blas::has_choice() {
        return None;
    }
    better(&blas::kernels()?, Vectors::of_processor()?)
}

/// Logs a warning if OpenBLAS uses slow kernels; at most one warning per process.
pub(super) fn warn_of_slow_kernels() {
    static SAID: Once = Once::new();
    SAID.call_once(|| {
        if let Some(warning) = slow_kernels() {
            log::warn!("{warning}");
        }
    });
}

/// Warning for the user of a library if OpenBLAS uses slower instructions than the processor has; a
/// process that is already running cannot change this.
pub fn slow_kernels() -> Option<String> {
    let better = better_kernels()?;
    Some(format!(
        "OpenBLAS uses its kernels for {}, which leave vector instructions of this processor \
         unused: set {KERNEL_SETTING}={better} before the process begins, and it is up to four \
         times faster",
        blas::kernels()?
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kernels_below_the_processor_are_replaced_and_no_others() {
        use Vectors::*;
        assert_eq!(better("Prescott", Fused512), Some("SkylakeX"));
        assert_eq!(better("Prescott", Fused256), Some("Haswell"));
        assert_eq!(better("Nehalem", Bits256), Some("Sandybridge"));
        assert_eq!(better("Zen", Fused512), Some("SkylakeX"));
        for (kernels, processor) in [
            ("Prescott", Bits128),
            ("Zen", Fused256),
            ("Haswell", Bits256),
            ("Cooperlake", Fused512),
            ("OneToCome", Fused512),
        ] {
            assert_eq!(better(kernels, processor), None, "{kernels}");
        }
    }

    #[test]
    fn what_is_chosen_is_enough_for_the_processor() {
        use Vectors::*;
        for processor in [Bits128, Bits256, Fused256, Fused512] {
            assert_eq!(Vectors::of_kernels(processor.kernels()), Some(processor));
        }
    }
}
