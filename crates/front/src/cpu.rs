//! The processor: a build for x86-64-v3 must say so on an older one instead of dying of an illegal
//! instruction.

/// Whether this processor can run this build; otherwise a sentence for the user.
#[cfg(all(target_arch = "x86_64", target_feature = "avx2"))]
pub fn check() -> Result<(), String> {
    use std::arch::x86_64::{__cpuid, __cpuid_count};
    // The compiler takes AVX2 for granted in this build, so the standard library's test would always
    // say yes: ask the processor itself. Bits: Intel 64 and IA-32 manual, volume 2A, CPUID.
    const FMA_AND_OSXSAVE: u32 = 1 << 12 | 1 << 27;
    const BMI1_AVX2_BMI2: u32 = 1 << 3 | 1 << 5 | 1 << 8;
    let basic = __cpuid(0).eax >= 7
        && __cpuid(1).ecx & FMA_AND_OSXSAVE == FMA_AND_OSXSAVE
        && __cpuid_count(7, 0).ebx & BMI1_AVX2_BMI2 == BMI1_AVX2_BMI2;
    if basic {
        return Ok(());
    }
    Err("error: this build of Indigo needs a processor with AVX2 and FMA (x86-64-v3: Intel Haswell, AMD Zen or \
         later).\nFor this machine build it with: RUSTFLAGS=\"\" cargo build --release"
        .to_owned())
}

/// Builds without such demands run everywhere.
#[cfg(not(all(target_arch = "x86_64", target_feature = "avx2")))]
pub fn check() -> Result<(), String> {
    Ok(())
}
