//! Fixed amounts of work of each kernel, whose instructions `cargo xtask counts` lets valgrind count.
//!
//! `counts KERNEL` prepares the work and does it once, inside [`indigo_counted`], the function that the count is about.
//! `counts` alone lists the kernels, those of AVX2 where there is AVX2. Instructions of one program are the same on every run, whatever else a machine does:
//! they can gate what seconds cannot.

#[path = "../../../render/tests/common/mod.rs"]
mod common;
mod kernels;

use kernels::KERNELS;
use std::hint::black_box;
use std::process::ExitCode;

/// What is counted; by this name valgrind knows it.
#[inline(never)]
fn indigo_counted(work: &mut dyn FnMut()) {
    black_box(&mut *work)();
    // Not the last call of this function, which would become a jump that is never seen to return.
    black_box(work);
}

/// Whether the ray kernel of that name is the one that is chosen here.
fn has_avx2() -> bool {
    #[cfg(target_arch = "x86_64")]
    return std::arch::is_x86_feature_detected!("avx2");
    #[cfg(not(target_arch = "x86_64"))]
    return false;
}

fn main() -> ExitCode {
    let wanted = std::env::args().skip(1).find(|argument| !argument.starts_with('-'));
    let Some(wanted) = wanted else {
        for kernel in KERNELS.iter().filter(|kernel| has_avx2() || !kernel.name.ends_with("_avx2")) {
            println!("{}", kernel.name);
        }
        return ExitCode::SUCCESS;
    };
    let Some(kernel) = KERNELS.iter().find(|kernel| kernel.name == wanted) else {
        eprintln!("no kernel {wanted}");
        return ExitCode::FAILURE;
    };
    indigo_counted(&mut *(kernel.prepare)());
    ExitCode::SUCCESS
}
