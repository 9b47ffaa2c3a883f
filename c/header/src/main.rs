//! Writes the header of the C interface, `c/include/sweep_and_prune.h`, from the comments and types of `c/src`.
//!
//! ```text
//! cargo run -p sweep-and-prune-c-header             writes it
//! cargo run -p sweep-and-prune-c-header -- --check  fails if it is not what would be written
//! ```

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::{env, fs};

use cbindgen::{
    Builder, Config, DocumentationLength, DocumentationStyle, Language, SortKey, Style,
};
use sweep_and_prune_c_kinds::{FILES, KINDS};

/// The first lines of the header.
const TOP: &str = include_str!("top.h");

/// The files of `c/src` that all kinds share and that say something to C.
const SHARED: [&str; 2] = ["failure.rs", "common.rs"];

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let crate_folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let path = crate_folder.join("include/sweep_and_prune.h");
    let header = header(&crate_folder.join("src"))?;
    if env::args().nth(1).as_deref() != Some("--check") {
        fs::write(path, header)?;
    } else if fs::read_to_string(path)? != header {
        eprintln!(
            "c/include/sweep_and_prune.h is not current: run `cargo run -p sweep-and-prune-c-header` in c/"
        );
        return Ok(ExitCode::FAILURE);
    }
    Ok(ExitCode::SUCCESS)
}

/// The text of the header, from the sources in a folder.
fn header(sources: &Path) -> Result<String, Box<dyn Error>> {
    let mut config = Config {
        language: Language::C,
        cpp_compat: true,
        usize_is_size_t: true,
        include_guard: Some("SWEEP_AND_PRUNE_H".into()),
        header: Some(TOP.trim_end().into()),
        no_includes: true,
        sys_includes: ["stdbool.h", "stddef.h", "stdint.h"].map(Into::into).to_vec(),
        style: Style::Both,
        documentation_style: DocumentationStyle::Cxx,
        documentation_length: DocumentationLength::Full,
        line_length: 110,
        tab_width: 4,
        ..Config::default()
    };
    config.function.sort_by = Some(SortKey::None);
    config.constant.sort_by = Some(SortKey::None);
    let folder = env::temp_dir().join(format!("sweep-and-prune-header-{}", std::process::id()));
    fs::create_dir_all(&folder)?;
    let written = generate(sources, &folder, config);
    fs::remove_dir_all(&folder)?;
    written
}

/// Generates the header from the shared sources and those of all kinds, for which `folder` has space.
fn generate(sources: &Path, folder: &Path, config: Config) -> Result<String, Box<dyn Error>> {
    let mut paths: Vec<PathBuf> = SHARED.iter().map(|file| sources.join(file)).collect();
    for kind in KINDS {
        for file in FILES {
            let path = folder.join(file.replace("3f", kind.name));
            fs::write(&path, kind.source(&fs::read_to_string(sources.join(file))?))?;
            paths.push(path);
        }
    }
    let builder = Builder::new().with_config(config);
    let bindings = paths.into_iter().fold(builder, Builder::with_src).generate()?;
    let mut text = Vec::new();
    bindings.write(&mut text);
    Ok(String::from_utf8(text)?)
}
