//! Whether OpenBLAS computes with the vectors that the processor has.
//!
//! OpenBLAS chooses its kernels by the model of the processor as it is loaded. A release that is
//! older than the processor does not know the model and takes those of an old one, with a half or a
//! quarter of the speed; `OPENBLAS_CORETYPE`, which it reads at the same moment, names others. So a
//! program can begin anew with the variable set ([`better_kernels`]), and a library can only say
//! so.

use super::blas;
use std::sync::Once;

/// What names the kernels to OpenBLAS, in the environment of a process as it begins.
pub const KERNEL_SETTING: &str = "OPENBLAS_CORETYPE";

/// How much of a vector one instruction takes, in the order of speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Vectors {
    /// SSE, vectors of 128 bits.
    Bits128,
    /// AVX, vectors of 256 bits: product and sum apart.
    Bits256,
    /// AVX2 and FMA, vectors of 256 bits: product and sum in one.
    Fused256,
    /// AVX-512 with its parts F, CD, BW, DQ and VL.
    Fused512,
}

impl Vectors {
    /// Vectors of OpenBLAS' kernels of a name (`driver/others/dynamic.c`); `None` of a name that is
    /// not known here, as of releases to come.
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

    /// Vectors of this processor, as far as its system lets programs use them.
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

    /// The kernels that every OpenBLAS with a choice has for them.
    fn kernels(self) -> &'static str {
        match self {
            Vectors::Bits128 => "Prescott",
            Vectors::Bits256 => "Sandybridge",
            Vectors::Fused256 => "Haswell",
            Vectors::Fused512 => "SkylakeX",
        }
    }
}

/// The kernels to choose in place of those of a name, by what the processor has; `None` where these
/// are as good.
fn better(kernels: &str, processor: Vectors) -> Option<&'static str> {
    (Vectors::of_kernels(kernels)? < processor).then(|| processor.kernels())
}

/// The value of `OPENBLAS_CORETYPE` ([`KERNEL_SETTING`]) with which this process would compute
/// faster; `None` where OpenBLAS uses what the processor has, has no choice of kernels, or was told
/// which.
pub fn better_kernels() -> Option<&'static str> {
    let is_told = std::env::var_os(KERNEL_SETTING).is_some();
    if is_told || !blas::has_choice() {
        return None;
    }
    better(&blas::kernels()?, Vectors::of_processor()?)
}

/// Says once in a process, through its log, that its kernels are slow.
pub(super) fn warn_of_slow_kernels() {
    static SAID: Once = Once::new();
    SAID.call_once(|| {
        if let Some(warning) = slow_kernels() {
            log::warn!("{warning}");
        }
    });
}

/// Warning for the user of a library where OpenBLAS computes with less than the processor has: a
/// process that has started cannot change that.
pub fn slow_kernels() -> Option<String> {
    let better = better_kernels()?;
    Some(format!(
        "OpenBLAS computes with its kernels for {}, which use less than this processor has: set \
         {KERNEL_SETTING}={better} before the process begins, and it is up to four times faster",
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
