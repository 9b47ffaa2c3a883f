//! Mutation testing of `core/src/pairs` and `core/src/world`: would the tests notice if one operator were another, one
//! condition negated or one statement missing?
//!
//! ```text
//! cargo run --manifest-path fuzz/mutants/Cargo.toml -- [COUNT] [SEED]
//! ```
//! All mutants are compiled at once into a copy of the repository, each behind a test of one number that the environment
//! variable `MUTANT` chooses: one build instead of one for each. Then a random sample of them (200 if not said otherwise) is
//! run, first by the random driver of `fuzz/` for some seconds, and if that notices nothing by the tests in `TESTS`. A run
//! that fails, crashes or does not end kills the mutant. The survivors are printed.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use proc_macro2::{Span, TokenStream};
use quote::ToTokens;
use syn::spanned::Spanned;
use syn::visit_mut::{self, VisitMut};
use syn::{Expr, Item, Stmt, UnOp, parse_quote};

/// What is mutated. Kernels of other processors are not compiled here.
const MUTATED: [&str; 2] = ["pairs", "world"];
const LEFT_OUT: [&str; 4] = ["neon.rs", "wasm.rs", "model.rs", "memory"];
/// What is copied.
const COPIED: [&str; 6] =
    ["Cargo.lock", "core", "scenes", "fuzz", "rust-toolchain.toml", "README.md"];
/// A mutant that takes so much longer does not end.
const PATIENCE: Duration = Duration::from_secs(240);

/// The program that replaces `cargo test` where it is enough, and how it is called.
const DRIVER: [&[&str]; 3] = [
    &["broad_phase", "--calls", "300000", "--threads", "1"],
    &["finder", "--calls", "1500", "--threads", "1"],
    &["snapshot", "--calls", "150000", "--threads", "1"],
];

/// Adds mutants to a file.
struct Mutator<'a> {
    file: String,
    mutants: &'a mut Vec<String>,
    /// Mutants that do not compile.
    skipped: &'a [usize],
}

impl Mutator<'_> {
    /// The number of a new mutant, unless it does not compile.
    fn add(&mut self, at: Span, what: String) -> Option<u32> {
        let id = self.mutants.len();
        self.mutants.push(format!("{}:{}: {what}", self.file, at.start().line));
        (!self.skipped.contains(&id)).then_some(id as u32)
    }
}

fn is_test(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        let text = attribute.to_token_stream().to_string();
        text.contains("cfg") && text.contains("test") || text.contains("cfg (not (feature")
    })
}

fn contains_let(expr: &Expr) -> bool {
    match expr {
        Expr::Let(_) => true,
        Expr::Binary(binary) => contains_let(&binary.left) || contains_let(&binary.right),
        _ => false,
    }
}

/// What stands in place of an operator.
fn replacement(operator: &impl ToTokens) -> Option<TokenStream> {
    const REPLACED: [[&str; 2]; 22] = [
        ["+", "-"],
        ["-", "+"],
        ["*", "+"],
        ["/", "*"],
        ["%", "+"],
        ["&&", "||"],
        ["||", "&&"],
        ["&", "|"],
        ["|", "&"],
        ["^", "|"],
        ["<<", ">>"],
        [">>", "<<"],
        ["==", "!="],
        ["!=", "=="],
        ["<", "<="],
        ["<=", "<"],
        [">", ">="],
        [">=", ">"],
        ["+=", "-="],
        ["-=", "+="],
        ["&=", "|="],
        ["|=", "&="],
    ];
    let operator = operator.to_token_stream().to_string();
    let [_, other] = REPLACED.iter().find(|[from, _]| *from == operator)?;
    Some(other.parse().expect("an operator"))
}

impl VisitMut for Mutator<'_> {
    fn visit_item_mut(&mut self, item: &mut Item) {
        match item {
            // Values that are known at compile time cannot depend on the environment.
            Item::Const(_) | Item::Static(_) | Item::Type(_) => {}
            Item::Mod(module) if is_test(&module.attrs) => {}
            Item::Fn(function) if function.sig.constness.is_some() || is_test(&function.attrs) => {}
            item => visit_mut::visit_item_mut(self, item),
        }
    }

    fn visit_impl_item_mut(&mut self, item: &mut syn::ImplItem) {
        match item {
            syn::ImplItem::Const(_) => {}
            syn::ImplItem::Fn(function) if function.sig.constness.is_some() => {}
            item => visit_mut::visit_impl_item_mut(self, item),
        }
    }

    fn visit_trait_item_const_mut(&mut self, _: &mut syn::TraitItemConst) {}
    fn visit_type_mut(&mut self, _: &mut syn::Type) {}
    fn visit_pat_mut(&mut self, _: &mut syn::Pat) {}
    fn visit_expr_const_mut(&mut self, _: &mut syn::ExprConst) {}
    fn visit_generic_argument_mut(&mut self, _: &mut syn::GenericArgument) {}
    fn visit_expr_repeat_mut(&mut self, repeat: &mut syn::ExprRepeat) {
        self.visit_expr_mut(&mut repeat.expr);
    }

    fn visit_expr_mut(&mut self, expr: &mut Expr) {
        visit_mut::visit_expr_mut(self, expr);
        let span = expr.span();
        match expr {
            Expr::Binary(binary) if !contains_let(&binary.left) && !contains_let(&binary.right) => {
                let Some(other) = replacement(&binary.op) else { return };
                let (left, right, op) = (&binary.left, &binary.right, &binary.op);
                let what = format!("{other} instead of {}", op.to_token_stream());
                if let Some(id) = self.add(op.span(), what) {
                    *expr = parse_quote!((if crate::mutants::is(#id) { #left #other #right } else { #left #op #right }));
                }
            }
            Expr::Unary(unary) if matches!(unary.op, UnOp::Not(_)) => {
                let inner = &unary.expr;
                if let Some(id) = self.add(span, "without !".into()) {
                    *expr = parse_quote!((if crate::mutants::is(#id) { #inner } else { !#inner }));
                }
            }
            Expr::If(branch) => {
                if matches!(
                    *branch.cond,
                    Expr::MethodCall(_) | Expr::Call(_) | Expr::Path(_) | Expr::Field(_)
                ) && let Some(id) = self.add(branch.cond.span(), "condition negated".into())
                {
                    let condition = &branch.cond;
                    *branch.cond = parse_quote!((#condition) ^ crate::mutants::is(#id));
                }
            }
            _ => {}
        }
    }

    fn visit_stmt_mut(&mut self, stmt: &mut Stmt) {
        let original = stmt.clone();
        visit_mut::visit_stmt_mut(self, stmt);
        let Stmt::Expr(expr, Some(_)) = &original else { return };
        let may_go = match expr {
            Expr::MethodCall(_) | Expr::Call(_) | Expr::Assign(_) | Expr::Try(_) => true,
            Expr::Binary(binary) => replacement(&binary.op).is_some(),
            _ => false,
        };
        if may_go && let Some(id) = self.add(expr.span(), "without this statement".into()) {
            let inner = stmt.clone();
            *stmt = parse_quote!(if !crate::mutants::is(#id) { #inner });
        }
    }
}

/// All Rust files in a folder.
fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut entries: Vec<_> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    let files = entries.into_iter().flat_map(|path| match path.is_dir() {
        true => rust_files(&path),
        false => vec![path],
    });
    files.filter(|path| path.extension().is_some_and(|extension| extension == "rs")).collect()
}

/// Writes the mutated sources. Returns what each mutant does.
fn mutate(root: &Path, copy: &Path, skipped: &[usize]) -> Vec<String> {
    let mut mutants = Vec::new();
    for file in MUTATED.iter().flat_map(|folder| rust_files(&root.join("core/src").join(folder))) {
        let name = file.strip_prefix(root).unwrap();
        if LEFT_OUT.iter().any(|part| name.ends_with(part)) {
            continue;
        }
        let mut source = syn::parse_file(&fs::read_to_string(&file).unwrap()).unwrap();
        let file = name.display().to_string();
        Mutator { file, mutants: &mut mutants, skipped }.visit_file_mut(&mut source);
        fs::write(copy.join(name), prettyplease::unparse(&source)).unwrap();
    }
    mutants
}

/// What decides in the copy which mutant is active.
const MUTANTS: &str = r#"
/// The active mutant.
mod mutants {
    static ACTIVE: std::sync::LazyLock<u32> = std::sync::LazyLock::new(|| {
        use std::string::ToString;
        std::env::var("MUTANT").ok().and_then(|text| text.to_string().parse().ok()).unwrap_or(u32::MAX)
    });

    #[inline]
    pub fn is(mutant: u32) -> bool {
        *ACTIVE == mutant
    }
}
"#;

/// Copies the repository.
fn copy(root: &Path, copy: &Path) {
    fs::create_dir_all(copy).unwrap();
    let from_to = COPIED.iter().map(|name| root.join(name)).chain([copy.to_path_buf()]);
    let status = Command::new("cp").arg("-r").args(from_to).status().unwrap();
    assert!(status.success());
    let manifest = fs::read_to_string(root.join("Cargo.toml")).unwrap();
    let members = manifest.lines().map(|line| match line.starts_with("members") {
        true => r#"members = ["core", "scenes", "fuzz"]"#,
        false => line,
    });
    let manifest: Vec<_> = members
        .filter(|line| {
            !line.contains("-simulation]") && *line != "undocumented_unsafe_blocks = \"deny\""
        })
        .collect();
    fs::write(copy.join("Cargo.toml"), manifest.join("\n").replace("missing_docs = \"deny\"", ""))
        .unwrap();
    let lib = copy.join("core/src/lib.rs");
    let text = fs::read_to_string(&lib).unwrap();
    fs::write(lib, text + MUTANTS).unwrap();
}

/// Builds programs in the copy. If that fails, the mutants that stand where the compiler reports an error.
fn build(copy: &Path, arguments: &[&str]) -> Result<String, Vec<usize>> {
    let out = Command::new("cargo")
        .current_dir(copy)
        .args(arguments)
        .args(["--profile", "checked", "--all-features", "--message-format", "short"])
        .env("RUSTFLAGS", "-Awarnings")
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&out.stderr).into_owned();
    if out.status.success() {
        return Ok(said);
    }
    let mut culprits = Vec::new();
    for line in said.lines().filter(|line| line.contains(": error")) {
        let mut parts = line.split(':');
        let (Some(file), Some(Ok(number))) = (parts.next(), parts.next().map(str::parse::<usize>))
        else {
            continue;
        };
        let Ok(text) = fs::read_to_string(copy.join(file)) else { continue };
        let lines: Vec<_> = text.lines().collect();
        // The mutant begins at or before the place of the error.
        for at in (number.saturating_sub(4)..(number + 1).min(lines.len())).rev() {
            let ids = lines[at].split("mutants::is(").skip(1);
            culprits.extend(
                ids.filter_map(|rest| rest.split(['u', ')']).next()?.parse::<usize>().ok()),
            );
            if !culprits.is_empty() && at < number {
                break;
            }
        }
    }
    assert!(!culprits.is_empty(), "the copy does not build:\n{said}");
    Err(culprits)
}

/// Whether a program passes with a mutant.
fn passes(program: &Path, arguments: &[&str], mutant: usize, folder: &Path) -> bool {
    let mut child = Command::new(program)
        .args(arguments)
        .current_dir(folder)
        .env("MUTANT", mutant.to_string())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    loop {
        if let Some(status) = child.try_wait().unwrap() {
            return status.success();
        }
        if begun.elapsed() > PATIENCE {
            let _ = child.kill();
            let _ = child.wait();
            return false;
        }
        sleep(Duration::from_millis(20));
    }
}

fn main() {
    let mut arguments = std::env::args().skip(1).map(|text| text.parse::<u64>().expect("numbers"));
    let (count, seed) = (arguments.next().unwrap_or(200) as usize, arguments.next().unwrap_or(1));
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap();
    let folder = root.join("target/mutants");
    copy(root, &folder);
    let mut skipped = Vec::new();
    let (mutants, tests) = loop {
        let mutants = mutate(root, &folder, &skipped);
        println!("{} mutants, {} of them do not compile", mutants.len(), skipped.len());
        let driver = build(&folder, &["build", "--package", "sweep-and-prune-fuzz"]);
        let tests = driver.and_then(|_| {
            build(
                &folder,
                &["test", "--no-run", "--package", "sweep-and-prune", "--test", "behavior"],
            )
        });
        match tests {
            Ok(said) => break (mutants, said),
            Err(culprits) => skipped.extend(culprits),
        }
    };
    let driver = folder.join("target/checked/sweep-and-prune-fuzz");
    let tests = tests.lines().find_map(|line| line.split("behavior-").nth(1));
    let tests = tests.expect("cargo names the test program").trim_end_matches(')');
    let tests = folder.join("target/checked/deps").join(format!("behavior-{tests}"));
    assert!(DRIVER.iter().all(|arguments| passes(&driver, arguments, usize::MAX, &folder)));
    assert!(
        passes(&tests, &[], usize::MAX, &folder.join("core")),
        "the tests fail without a mutant"
    );

    // SplitMix64, as in `scenes/`.
    let mut state = seed;
    let mut random = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    };
    let mut left: Vec<_> = (0..mutants.len()).filter(|id| !skipped.contains(id)).collect();
    let mut counts = [0; 3];
    while counts.iter().sum::<usize>() < count && !left.is_empty() {
        let mutant = left.swap_remove((random() % left.len() as u64) as usize);
        let survives_driver =
            DRIVER.iter().all(|arguments| passes(&driver, arguments, mutant, &folder));
        let end = match survives_driver && passes(&tests, &[], mutant, &folder.join("core")) {
            true => 2,
            false => usize::from(survives_driver),
        };
        counts[end] += 1;
        let how = ["killed by random inputs", "killed by the tests", "SURVIVES"][end];
        println!("{how}: {mutant} {}", mutants[mutant]);
    }
    println!(
        "{} killed by random inputs, {} by the tests, {} survive",
        counts[0], counts[1], counts[2]
    );
}
