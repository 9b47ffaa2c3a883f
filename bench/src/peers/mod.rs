//! The contenders: ours and its peers, each in its own short file, used as its own documentation
//! recommends for finding all pairs of a set of boxes once.

use anyhow::Result;
use sweep_and_prune::Aabb;

pub mod ours;
mod plain;

#[cfg(feature = "light")]
mod broccoli;
#[cfg(feature = "cpp")]
pub mod cpp;
#[cfg(feature = "light")]
mod geo_index;
#[cfg(feature = "light")]
mod obvhs;
#[cfg(feature = "light")]
mod packed_spatial_index;
#[cfg(feature = "light")]
pub mod parry;
#[cfg(feature = "physx")]
pub mod physx;
#[cfg(feature = "light")]
mod rstar;

/// The name of the contender that every ratio is taken against.
pub const OURS: &str = "ours";

/// The name of ours on two threads.
pub const OURS_ON_TWO: &str = "ours, 2 threads";

/// The name of ours called with the boxes of the last call.
pub const OURS_AGAIN: &str = "ours, again";

/// The name of two of ours at once.
pub const OURS_TWICE: &str = "ours, two at once";

/// Who is asked beside ours where the question is how flat ours is, and not who is faster.
/// The first is seldom slow.
pub const WITNESSES: [&str; 3] = ["packed_spatial_index", "parry", "plain sweep"];

/// Finds all pairs, from raw boxes to pairs stored in memory.
///
/// A contender may keep buffers and workspaces between calls, but no knowledge of the boxes:
/// every call starts from the boxes alone.
pub trait Contender<const D: usize> {
    /// The pairs of indices of `boxes` that overlap, each once, in any order and orientation.
    fn find<'a>(&'a mut self, boxes: &'a [Aabb<D>]) -> Result<&'a [[u32; 2]]>;

    /// Called untimed before each timed call with the same boxes in another order, so that a
    /// contender that learns from call to call has nothing to start from.
    fn forget(&mut self, _shuffled: &[Aabb<D>]) -> Result<()> {
        Ok(())
    }
}

/// Makes a contender.
pub type Maker<const D: usize> = fn() -> Box<dyn Contender<D>>;

/// A contender as the harness knows it, by what makes it for two dimensions and for three.
#[derive(Clone, Copy)]
pub struct Peer<Two = Maker<2>, Three = Maker<3>> {
    /// How tables, plots and the command line call it.
    pub name: &'static str,
    /// Where it comes from, for the version.
    pub origin: Origin,
    /// In one line: which of its functions are called, and what was adapted.
    pub how: &'static str,
    /// Whether it competes with ours, or is ours in another setting.
    pub rival: bool,
    /// Makes it for two dimensions.
    pub two: Option<Two>,
    /// Makes it for three dimensions.
    pub three: Option<Three>,
}

/// Where a contender comes from.
#[derive(Clone, Copy)]
pub enum Origin {
    /// This repository.
    Here,
    /// A crate of this name.
    Crate(&'static str),
    /// A Debian package of this name.
    #[allow(dead_code, reason = "only some features have peers from Debian")]
    Debian(&'static str),
}

/// All contenders that were compiled in, ours first.
pub fn all() -> Vec<Peer> {
    let mut peers = vec![ours::PEER, ours::TWO_THREADS, ours::TWICE, ours::AGAIN, ours::FRESH];
    peers.extend([plain::SWEEP, plain::BRUTE_FORCE]);
    #[cfg(feature = "light")]
    peers.extend([
        broccoli::PEER,
        geo_index::PEER,
        obvhs::PEER,
        packed_spatial_index::PEER,
        parry::PEER,
        rstar::PEER,
    ]);
    #[cfg(feature = "cpp")]
    peers.extend_from_slice(cpp::PEERS);
    #[cfg(feature = "physx")]
    peers.extend([physx::AUTOMATIC, physx::MULTIPLE]);
    peers
}

/// What is known of a contender without making it.
#[derive(Clone)]
pub struct Entrant {
    /// As [`Peer::name`].
    pub name: &'static str,
    /// As [`Peer::how`].
    pub how: &'static str,
    /// As [`Peer::rival`].
    pub rival: bool,
    /// The version that was compiled in, or a word on where it comes from.
    pub version: String,
    /// The numbers of dimensions in which it exists.
    pub dimensions: Vec<usize>,
}

impl<Two, Three> Peer<Two, Three> {
    /// What is known of it without making it.
    pub fn entrant(&self) -> Entrant {
        let exists = [(2, self.two.is_some()), (3, self.three.is_some())];
        Entrant {
            name: self.name,
            how: self.how,
            rival: self.rival,
            version: self.version(),
            dimensions: exists.iter().filter(|(_, it)| *it).map(|&(count, _)| count).collect(),
        }
    }

    /// The version that was compiled in, or a word on where it comes from.
    fn version(&self) -> String {
        match self.origin {
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

/// A corner in three dimensions for peers that know no others: the missing coordinates are 0.
#[allow(dead_code, reason = "not every set of features has such a peer")]
pub fn lift<const D: usize>(corner: [f32; D]) -> [f32; 3] {
    std::array::from_fn(|axis| corner.get(axis).copied().unwrap_or(0.0))
}
