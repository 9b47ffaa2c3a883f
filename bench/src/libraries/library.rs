//! What a library is to the harness: how it finds pairs, how it is called, and of which version it is.

use anyhow::Result;
use sweep_and_prune::Aabb;

/// The name of the library that every ratio is taken against.
pub const THIS_CRATE: &str = "sweep-and-prune";

/// The name of this library on two threads.
pub const ON_TWO_THREADS: &str = "sweep-and-prune, 2 threads";

/// The name of two finders of this library at the same time.
pub const TWO_AT_ONCE: &str = "sweep-and-prune, two at once";

/// The alternatives that are measured where the question is how this library scales, not which library is
/// faster. The first one is seldom slow.
pub const WITNESSES: [&str; 3] = ["packed_spatial_index", "parry", "plain sweep"];

/// Finds all pairs, from raw boxes to pairs stored in memory.
///
/// A library may keep buffers and workspaces between calls, but no knowledge of the boxes:
/// every call starts from the boxes alone.
pub trait Finder<const D: usize> {
    /// The pairs of indices of `boxes` that overlap, each once, in any order and orientation.
    fn find<'a>(&'a mut self, boxes: &'a [Aabb<D>]) -> Result<&'a [[u32; 2]]>;

    /// Called before each timed call, untimed, with the same boxes in another order. So a library that learns from call to
    /// call has nothing to start from.
    fn forget(&mut self, _shuffled: &[Aabb<D>]) -> Result<()> {
        Ok(())
    }
}

/// Makes a library.
pub type Maker<const D: usize> = fn() -> Box<dyn Finder<D>>;

/// A library as the harness knows it, by what makes it for two dimensions and for three.
#[derive(Clone, Copy)]
pub struct Library<Two = Maker<2>, Three = Maker<3>> {
    /// How tables, plots and the command line call it.
    pub name: &'static str,
    /// Where it comes from, for the version.
    pub origin: Origin,
    /// In one line: which of its functions are called, and what was adapted.
    pub how: &'static str,
    /// Whether it is another library, or this one in another setting.
    pub alternative: bool,
    /// Makes it for two dimensions.
    pub two: Option<Two>,
    /// Makes it for three dimensions.
    pub three: Option<Three>,
}

/// Where a library comes from.
#[derive(Clone, Copy)]
pub enum Origin {
    /// This repository.
    Here,
    /// A crate of this name.
    #[allow(dead_code, reason = "only some features have alternatives from crates")]
    Crate(&'static str),
    /// A Debian package of this name.
    #[allow(dead_code, reason = "only some features have libraries from Debian")]
    Debian(&'static str),
}

/// What is known of a library without making it.
#[derive(Clone)]
pub struct LibraryInfo {
    /// As [`Library::name`].
    pub name: &'static str,
    /// As [`Library::how`].
    pub how: &'static str,
    /// As [`Library::alternative`].
    pub alternative: bool,
    /// The version that was compiled in, or its origin.
    pub version: String,
    /// The crate or Debian package that it is from; `None` for this repository.
    pub package: Option<&'static str>,
    /// The numbers of dimensions in which it exists.
    pub dimensions: Vec<usize>,
}

impl<Two, Three> Library<Two, Three> {
    /// What is known of it without making it.
    pub fn info(&self) -> LibraryInfo {
        let exists = [(2, self.two.is_some()), (3, self.three.is_some())];
        LibraryInfo {
            name: self.name,
            how: self.how,
            alternative: self.alternative,
            version: self.origin.version(),
            package: self.origin.package(),
            dimensions: exists.iter().filter(|(_, it)| *it).map(|&(count, _)| count).collect(),
        }
    }
}

impl Origin {
    /// The crate or Debian package, if it is one.
    pub fn package(&self) -> Option<&'static str> {
        match *self {
            Origin::Here => None,
            Origin::Crate(name) | Origin::Debian(name) => Some(name),
        }
    }

    /// The version that was compiled in, or the origin.
    pub fn version(&self) -> String {
        match self {
            Origin::Here => "this repository".into(),
            Origin::Crate(name) => crate_version(name).unwrap_or("unknown").into(),
            Origin::Debian(package) => debian_version(package).unwrap_or_else(|| "unknown".into()),
        }
    }
}

/// The highest version of a crate in the lock file, which lists them in ascending order.
fn crate_version(name: &str) -> Option<&'static str> {
    let lock = include_str!("../../Cargo.lock");
    let start = format!("name = \"{name}\"\nversion = \"");
    let from = lock.rfind(&start)? + start.len();
    lock[from..].split('"').next()
}

fn debian_version(package: &str) -> Option<String> {
    let asked = std::process::Command::new("dpkg-query")
        .args(["--show", "--showformat=${Version}", package])
        .output()
        .ok()?;
    asked.status.success().then(|| String::from_utf8_lossy(&asked.stdout).into_owned())
}

/// A corner in three dimensions for libraries that know no others: the missing coordinates are 0.
#[allow(dead_code, reason = "not every set of features has such a library")]
pub fn lift<const D: usize>(corner: [f32; D]) -> [f32; 3] {
    std::array::from_fn(|axis| corner.get(axis).copied().unwrap_or(0.0))
}
