//! Makes the code of the remote calls from their definition.

fn main() -> Result<(), Box<dyn std::error::Error>> {
    const DEFINITION: &str = "indigo.proto";
    println!("cargo::rerun-if-changed=proto/{DEFINITION}");
    let definition = protox::compile([DEFINITION], ["proto"])?;
    // Chunks are passed on without being copied.
    tonic_prost_build::configure().bytes(".").compile_fds(definition)?;
    Ok(())
}
