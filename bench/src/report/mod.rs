//! The table and the plots (to come).
use std::path::Path;
/// Nothing yet.
pub fn write(_: &Path) -> anyhow::Result<()> {
    Ok(())
}
