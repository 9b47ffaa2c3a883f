//! Writes the source for the kinds other than `3f`, and gives the shared library its name and version.

use std::env::var;
use std::fs::{read_to_string, write};
use std::path::Path;

use sweep_and_prune_c_kinds::{FILES, KINDS};

fn main() {
    let out = var("OUT_DIR").expect("Cargo sets it");
    for file in FILES {
        let path = Path::new("src").join(file);
        println!("cargo::rerun-if-changed={}", path.display());
        let source = read_to_string(path).expect("it is there");
        for kind in &KINDS[1..] {
            let to = Path::new(&out).join(file.replace("3f", kind.name));
            write(to, kind.source(&source)).expect("Cargo made the folder");
        }
    }
    // Before 1.0, each second number is another interface.
    let [major, minor] = ["MAJOR", "MINOR"]
        .map(|which| var(format!("CARGO_PKG_VERSION_{which}")).expect("Cargo sets it"));
    let version = if major == "0" { format!("0.{minor}") } else { major };
    if var("CARGO_CFG_TARGET_OS").as_deref() == Ok("linux") {
        println!("cargo::rustc-cdylib-link-arg=-Wl,-soname,libsweep_and_prune.so.{version}");
    }
}
