//! Tells the program which compiler built it, and builds the alternatives in C++ where they are wanted.

use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let compiler = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".into());
    let version = Command::new(compiler).arg("--version").output();
    let version = version.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned());
    println!("cargo::rustc-env=RUSTC_VERSION={}", version.unwrap_or_default());
    #[cfg(feature = "cpp")]
    cpp();
}

/// The libraries are those of the Debian packages that `bench/run` installs.
#[cfg(feature = "cpp")]
fn cpp() {
    println!("cargo::rerun-if-changed=cpp");
    let mut build = cc::Build::new();
    build
        .cpp(true)
        .std("c++17")
        .opt_level(3)
        .define("NDEBUG", None)
        .warnings(false)
        .cargo_warnings(false);
    let mut libraries = pkg_config::Config::new();
    // Cargo would otherwise link only what Rust itself names, and drop what comes before its user.
    libraries.cargo_metadata(false);
    let found: Vec<_> = ["bullet", "ode", "fcl"]
        .map(|name| libraries.probe(name).unwrap_or_else(|error| panic!("{error}")))
        .into();
    build.includes(found.iter().flat_map(|library| &library.include_paths));
    let sources = ["pairs", "boost", "bullet", "cgal", "fcl", "ode"];
    build.files(sources.map(|source| format!("cpp/{source}.cpp"))).compile("bench_libraries");
    for library in found.iter().flat_map(|library| &library.libs) {
        println!("cargo::rustc-link-lib={library}");
    }
}
