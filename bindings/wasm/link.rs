//! The build script of each WebAssembly file that uses this crate: options for the linker.

fn main() {
    // A change of this file runs it; it reads no other.
    println!("cargo:rerun-if-env-changed=CARGO_CFG_TARGET_ARCH");
    if std::env::var("CARGO_CFG_TARGET_ARCH").is_ok_and(|arch| arch == "wasm32") {
        // JavaScript puts the stack pointer back where a call was left by throwing.
        println!("cargo:rustc-link-arg-cdylib=--export=__stack_pointer");
        // No call recurses deeply: 256 KiB, against the default of 1 MiB. At the low end of
        // memory, where an overflow traps instead of overwriting data.
        println!("cargo:rustc-link-arg-cdylib=-zstack-size=262144");
        println!("cargo:rustc-link-arg-cdylib=--stack-first");
    }
}
