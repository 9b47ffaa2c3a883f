//! What the times depend on: the processor, its clock, its memory.

use std::fmt::Display;
use std::hint::black_box;
use std::process::Command;
use std::time::{Duration, Instant};

use crate::record::Machine;

/// Far more than the caches hold.
const MANY_BYTES: usize = 128 << 20;

/// Measures the clock and the memory (a quarter of a second) and asks the system for the rest.
pub fn describe() -> Machine {
    Machine {
        cpu: cpu(),
        cores: std::thread::available_parallelism().map_or(1, usize::from),
        vectors: vectors(),
        memory_bytes: kilobytes("/proc/meminfo", "MemTotal:"),
        system: system(),
        tsc_mhz: tsc_mhz(),
        copy_bytes_per_second: copy_bandwidth(2 * MANY_BYTES),
        load: load(),
    }
}

fn cpu() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let field = |name: &str| {
        let line = info.lines().find(|line| line.split(':').next().map(str::trim) == Some(name))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    };
    match (field("model name"), field("cpu family"), field("model")) {
        (Some(name), Some(family), Some(model)) => {
            format!("{name} (family {family} model {model})")
        }
        (Some(name), ..) => name,
        _ => std::env::consts::ARCH.into(),
    }
}

#[cfg(target_arch = "x86_64")]
fn vectors() -> Vec<String> {
    let mut vectors = vec!["sse2"];
    if is_x86_feature_detected!("avx2") {
        vectors.push("avx2");
    }
    if is_x86_feature_detected!("avx512f") {
        vectors.push("avx512f");
    }
    vectors.into_iter().map(str::to_owned).collect()
}

#[cfg(not(target_arch = "x86_64"))]
fn vectors() -> Vec<String> {
    Vec::new()
}

fn system() -> String {
    let release = std::fs::read_to_string("/proc/sys/kernel/osrelease").unwrap_or_default();
    format!("{} {}", std::env::consts::OS, release.trim()).trim().to_owned()
}

fn load() -> Option<f64> {
    std::fs::read_to_string("/proc/loadavg").ok()?.split(' ').next()?.parse().ok()
}

/// Ticks of the time stamp counter in a microsecond, over a fifth of a second of the system's
/// clock.
#[cfg(target_arch = "x86_64")]
fn tsc_mhz() -> Option<f64> {
    let (start, ticks) = (Instant::now(), read_tsc());
    std::thread::sleep(Duration::from_millis(200));
    let (elapsed, ticks) = (start.elapsed(), read_tsc().wrapping_sub(ticks));
    Some(ticks as f64 / elapsed.as_secs_f64() / 1e6)
}

#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code)]
fn read_tsc() -> u64 {
    // SAFETY: every x86-64 processor has the instruction, and it touches no memory.
    unsafe { std::arch::x86_64::_rdtsc() }
}

#[cfg(not(target_arch = "x86_64"))]
fn tsc_mhz() -> Option<f64> {
    None
}

/// Bytes read plus bytes written a second by one thread that copies half of these bytes: the best
/// of several copies. Few bytes stay in the caches.
pub fn copy_bandwidth(bytes: usize) -> f64 {
    let half = (bytes / 2).max(1);
    let from = vec![1u8; half];
    let mut to = vec![2u8; half];
    let copy = || {
        let start = Instant::now();
        black_box(&mut to).copy_from_slice(black_box(&from));
        start.elapsed().max(Duration::from_nanos(1))
    };
    let copies = (MANY_BYTES / half).clamp(6, 200);
    let best = std::iter::repeat_with(copy).take(copies).min().unwrap_or(Duration::MAX);
    2.0 * half as f64 / best.as_secs_f64()
}

/// The commit that is checked out, marked if files differ from it; `None` outside of Git.
pub fn revision() -> Option<String> {
    let git = Command::new("git")
        .args(["-C", env!("CARGO_MANIFEST_DIR"), "describe", "--always", "--dirty"])
        .output()
        .ok()?;
    git.status.success().then(|| String::from_utf8_lossy(&git.stdout).trim().to_owned())
}

/// How long the main thread of a process has waited for a processor while other programs used them all. Zero where the
/// system does not report it.
pub fn waited(process: impl Display) -> Duration {
    // Nanoseconds run, nanoseconds waited, time slices.
    let text = std::fs::read_to_string(format!("/proc/{process}/schedstat")).unwrap_or_default();
    let waited = text.split(' ').nth(1).and_then(|number| number.parse().ok());
    Duration::from_nanos(waited.unwrap_or(0))
}

/// A shorter time is taken as it is: it is seldom interrupted, and asking whether it was would take as long.
const WAIT_COUNTS: Duration = Duration::from_micros(100);

/// How long something takes, without what this thread waited for a processor.
pub fn clock<R>(work: impl FnOnce() -> R) -> (R, Duration) {
    let (waiting, start) = (waited("self"), Instant::now());
    let result = work();
    let mut elapsed = start.elapsed();
    if elapsed > WAIT_COUNTS {
        elapsed = elapsed.saturating_sub(waited("self").saturating_sub(waiting));
    }
    (result, elapsed)
}

/// The memory that the process has in use, in bytes; `None` off Linux.
pub fn memory() -> Option<u64> {
    kilobytes("/proc/self/status", "VmRSS:")
}

/// The most memory that the process had in use since [`reset_peak_memory`], in bytes; `None` off
/// Linux.
pub fn peak_memory() -> Option<u64> {
    kilobytes("/proc/self/status", "VmHWM:")
}

/// Lets [`peak_memory`] count from now on. Where the system does not allow it, the peak is that
/// since the start of the process.
pub fn reset_peak_memory() {
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}

fn kilobytes(file: &str, name: &str) -> Option<u64> {
    let text = std::fs::read_to_string(file).ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? * 1024)
}
