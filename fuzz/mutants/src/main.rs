//! Mutation testing of `core/src/pairs` and `core/src/world`: would the tests notice if one operator were another, one
//! condition negated or one statement missing?
//!
//! ```text
//! cargo run --manifest-path fuzz/mutants/Cargo.toml -- [COUNT] [SEED]
//! ```
//! All mutants are compiled at once into a copy of the repository, each behind a test of one number that the environment
//! variable `MUTANT` chooses: one build instead of one for each. Then a random sample of them (200 if not said otherwise) is
//! run, first by the random driver of `fuzz/` for some seconds, and if that notices nothing by the tests of the core. A run
//! that fails, crashes or does not end kills the mutant.

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
const LEFT_OUT: [&str; 4] = ["neon.rs", "wasm.rs", "model.rs", "hard_scenes.rs"];
/// What decides only how long a search takes: of the mutants here that survive, some are only slower or faster.
const SPEED: [&str; 5] = ["plan/", "crowding.rs", "schedule.rs", "policy/", "layout.rs"];
/// What is copied.
const COPIED: [&str; 8] = [
    "Cargo.lock",
    "core",
    "scenes",
    "fuzz",
    "rust-toolchain.toml",
    "README.md",
    "LICENSE-MIT",
    "LICENSE-APACHE",
];

/// The random driver: a program, and how it is called.
const DRIVER: &str = "sweep-and-prune-fuzz";
/// What a mutant has to survive first: random inputs.
const RANDOM: [(&str, &[&str]); 3] = [
    (DRIVER, &["broad_phase", "--calls", "100000", "--threads", "1"]),
    (DRIVER, &["finder", "--calls", "500", "--threads", "1"]),
    (DRIVER, &["snapshot", "--calls", "50000", "--threads", "1"]),
];
/// And then the tests of the core, but for those of the algorithms that the site shows and of the index, which are not
/// mutated.
const TESTS: [(&str, &[&str]); 5] = [
    ("sweep_and_prune", &[]),
    ("behavior", &["pairs::", "broad_phase", "errors::", "send_sync::"]),
    ("broad_phase_allocations", &[]),
    ("pairs_memory", &[]),
    ("out_of_memory", &[]),
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

/// Whether something is compiled only for tests, or without optional features.
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
                    *expr = parse_quote!((if crate::mutants::is(#id) { (#left) #other (#right) } else { (#left) #op (#right) }));
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
    use core::sync::atomic::{AtomicU32, Ordering};

    /// 0 before the environment was read, else one more than the number of the mutant.
    static ACTIVE: AtomicU32 = AtomicU32::new(0);

    #[inline(always)]
    pub fn is(mutant: u32) -> bool {
        let active = ACTIVE.load(Ordering::Relaxed);
        if active == 0 { read() == mutant + 1 } else { active == mutant + 1 }
    }

    #[cold]
    #[inline(never)]
    fn read() -> u32 {
        let number = std::env::var("MUTANT").ok().and_then(|text| text.parse::<u32>().ok());
        let active = number.map_or(u32::MAX, |number| number + 1);
        ACTIVE.store(active, Ordering::Relaxed);
        active
    }
}
"#;

/// Copies the repository, as a workspace of what is tested here.
fn copy(root: &Path, copy: &Path) {
    fs::create_dir_all(copy).unwrap();
    let from_to = COPIED.iter().map(|name| root.join(name)).chain([copy.to_path_buf()]);
    let status = Command::new("cp").arg("-r").args(from_to).status().unwrap();
    assert!(status.success());
    let manifest = fs::read_to_string(root.join("Cargo.toml")).unwrap();
    let sections = manifest.split("\n\n").filter(|section| {
        !section.contains("lints")
            && !section.contains("checked.package.sweep-and-prune-simulation")
    });
    let lines = sections.flat_map(|section| section.lines().chain([""]));
    let lines: Vec<_> = lines
        .map(|line| match line.starts_with("members") {
            true => r#"members = ["core", "scenes", "fuzz"]"#,
            false => line,
        })
        .chain(["[workspace.lints.rust]"])
        .collect();
    // The build takes longer than what is run.
    let manifest = lines.join("\n").replace("opt-level = 3", "opt-level = 1");
    fs::write(copy.join("Cargo.toml"), manifest).unwrap();
    let lib = copy.join("core/src/lib.rs");
    let text = fs::read_to_string(&lib).unwrap();
    fs::write(lib, text + MUTANTS).unwrap();
}

/// Runs cargo in the copy, and returns what it said and whether it succeeded.
fn cargo(copy: &Path, arguments: &[&str]) -> (String, bool) {
    let out = Command::new("cargo")
        .current_dir(copy)
        .args(arguments)
        .args(["--profile", "checked", "--all-features", "--message-format", "short"])
        .env("RUSTFLAGS", "-Awarnings")
        .output()
        .unwrap();
    (String::from_utf8_lossy(&out.stderr).into_owned(), out.status.success())
}

/// The mutants that stand where the compiler reports an error.
fn culprits(copy: &Path) -> Vec<usize> {
    let (said, is_right) = cargo(copy, &["check", "--package", "sweep-and-prune"]);
    if is_right {
        return Vec::new();
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
        let ids_in = |line: &&str| -> Vec<usize> {
            let ids = line.split("mutants::is(").skip(1);
            ids.filter_map(|rest| rest.split('u').next()?.parse().ok()).collect()
        };
        // The mutant begins at or before the place of the error; or it is a statement below without which a borrow lasts.
        let mut before = lines[number.saturating_sub(5)..number].iter().rev().map(ids_in);
        let after = lines[number..lines.len().min(number + 5)].iter().flat_map(ids_in);
        culprits.extend(before.find(|ids| !ids.is_empty()).unwrap_or_else(|| after.collect()));
    }
    assert!(!culprits.is_empty(), "the copy does not build:\n{said}");
    culprits
}

/// Builds programs in the copy, and makes sure that they pass without a mutant.
fn prepare(copy: &Path, runs: &'static [(&str, &[&str])]) -> Vec<Run> {
    let names = runs.iter().filter(|run| run.0 != DRIVER).map(|run| run.0);
    let tests: Vec<_> = names.flat_map(|name| ["--test", name]).skip(2).collect();
    let (said, is_right) = if tests.is_empty() {
        cargo(copy, &["build", "--package", DRIVER])
    } else {
        let arguments = ["test", "--no-run", "--package", "sweep-and-prune", "--lib"];
        cargo(copy, &[&arguments[..], &tests].concat())
    };
    assert!(is_right, "the copy does not build:\n{said}");
    let prepared = runs.iter().map(|&(name, arguments)| {
        // "Executable tests/behavior/main.rs (target/checked/deps/behavior-0123456789abcdef)"
        let marker = format!("/{name}-");
        let test = said.lines().find(|line| line.contains(&marker) && !line.contains("fuzz"));
        let test =
            test.and_then(|line| Some(line.trim_end().strip_suffix(')')?.rsplit_once('(')?.1));
        let program = copy.join(test.unwrap_or("target/checked/sweep-and-prune-fuzz"));
        let mut run = Run { name, program, arguments, folder: copy.join("core"), seconds: 3600 };
        let begun = Instant::now();
        assert!(run.passes(None), "{name} fails without a mutant");
        println!("{name} {arguments:?}: {:.1} s", begun.elapsed().as_secs_f64());
        run.seconds = 5 + 4 * begun.elapsed().as_secs();
        run
    });
    prepared.collect()
}

/// A program that runs with each mutant.
struct Run {
    name: &'static str,
    program: PathBuf,
    arguments: &'static [&'static str],
    folder: PathBuf,
    /// How much processor time it may take.
    seconds: u64,
}

impl Run {
    /// Whether it passes with a mutant, if there is one.
    fn passes(&self, mutant: Option<usize>) -> bool {
        let mut command = Command::new("sh");
        // A mutant may neither run nor allocate without end.
        command
            .args(["-c", r#"ulimit -t "$0"; ulimit -v 8000000; exec "$@""#])
            .arg(self.seconds.to_string())
            .arg(&self.program)
            .args(self.arguments)
            .current_dir(&self.folder)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        if let Some(mutant) = mutant {
            command.env("MUTANT", mutant.to_string());
        }
        let mut child = command.spawn().unwrap();
        let begun = Instant::now();
        loop {
            if let Some(status) = child.try_wait().unwrap() {
                return status.success();
            }
            // Threads that wait for each other take no processor time.
            if begun.elapsed() > 20 * Duration::from_secs(self.seconds) {
                let _ = child.kill();
                let _ = child.wait();
                return false;
            }
            sleep(Duration::from_millis(20));
        }
    }
}

fn main() {
    let mut arguments = std::env::args().skip(1).map(|text| text.parse::<u64>().expect("numbers"));
    let (count, seed) = (arguments.next().unwrap_or(200) as usize, arguments.next().unwrap_or(1));
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap();
    let folder = root.join("target/mutants");
    copy(root, &folder);
    let mut skipped = Vec::new();
    let mutants = loop {
        let mutants = mutate(root, &folder, &skipped);
        println!("{} mutants, {} of them do not compile", mutants.len(), skipped.len());
        match &culprits(&folder)[..] {
            [] => break mutants,
            more => skipped.extend(more),
        }
    };

    // SplitMix64, as in `scenes/`.
    let mut state = seed;
    let mut random = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    };
    let mut left: Vec<_> = (0..mutants.len()).filter(|id| !skipped.contains(id)).collect();
    let mut sample = Vec::new();
    while sample.len() < count && !left.is_empty() {
        sample.push(left.swap_remove((random() % left.len() as u64) as usize));
    }
    // Killed by random inputs, killed by the tests, surviving: where results are decided, and where only speed is.
    let mut counts = [[0; 3]; 2];
    for (stage, runs) in [&RANDOM[..], &TESTS[..]].into_iter().enumerate() {
        let runs = prepare(&folder, runs);
        sample.retain(|&mutant| {
            let killer = runs.iter().find(|run| !run.passes(Some(mutant)));
            let is_speed = SPEED.iter().any(|part| mutants[mutant].contains(part));
            let how = match killer {
                Some(run) => run.name,
                None if stage == 0 => "survives random inputs",
                None if is_speed => "SURVIVES (speed)",
                None => "SURVIVES",
            };
            if killer.is_some() || stage == 1 {
                counts[usize::from(is_speed)][if killer.is_some() { stage } else { 2 }] += 1;
            }
            println!("{how}: {mutant} {}", mutants[mutant]);
            killer.is_none()
        });
    }
    for (what, [random, tests, survive]) in ["results are", "only speed is"].iter().zip(counts) {
        println!(
            "where {what} decided: {random} killed by random inputs, {tests} by the tests, {survive} survive"
        );
    }
}
