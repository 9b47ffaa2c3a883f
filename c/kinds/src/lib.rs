//! The C interface has each function for four kinds of boxes: 2D and 3D, `f32` and `f64`. Its source is written for the
//! kind `3f`, as files that are compiled like any other; this crate writes the files of the other kinds from them.
//!
//! Rust's macros could do that too, but `cbindgen`, which makes the header, does not see through them.

/// The files of `c/src` that are written for the kind `3f`, in the order of the header.
pub const FILES: [&str; 4] = ["boxes3f.rs", "finder3f.rs", "world3f.rs", "queries3f.rs"];

/// A kind of boxes.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// What its names have in place of `3f`.
    pub name: &'static str,
    /// How many axes a box has.
    pub dimensions: &'static str,
    /// The type of its coordinates.
    pub scalar: &'static str,
}

/// The kinds in the order of the header; the first is the one that the source is written for.
pub const KINDS: [Kind; 4] = [
    Kind { name: "3f", dimensions: "3", scalar: "f32" },
    Kind { name: "2f", dimensions: "2", scalar: "f32" },
    Kind { name: "3d", dimensions: "3", scalar: "f64" },
    Kind { name: "2d", dimensions: "2", scalar: "f64" },
];

impl Kind {
    /// The source for this kind, from that for `3f`.
    #[must_use]
    pub fn source(self, source: &str) -> String {
        let lines = source.lines().filter(|line| !line.starts_with("//!"));
        let source = lines.collect::<Vec<_>>().join("\n") + "\n";
        source
            .replace("3f", self.name)
            .replace("3, f32>", &format!("{}, f32>", self.dimensions))
            .replace("f32", self.scalar)
            .replace("; 3]", &format!("; {}]", self.dimensions))
            .replace("3 numbers", &format!("{} numbers", self.dimensions))
    }
}
