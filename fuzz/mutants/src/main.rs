//! Mutation testing of `core/src/pairs` and `core/src/world`: would the tests notice if one operator were another, one
//! condition negated or one statement missing?
//!
//! ```text
//! cargo run --manifest-path fuzz/mutants/Cargo.toml -- [COUNT] [SEED]
//! cargo run --manifest-path fuzz/mutants/Cargo.toml -- "pairs/brute.rs:28: && instead of ||"...
//! ```
//! All mutants are compiled at once into a copy of the repository, each behind a test of one number that the environment
//! variable `MUTANT` chooses: one build instead of one for each. Then a random sample of them (200 if not said otherwise) is
//! run, or those whose names end as an argument says: with the unit tests, random inputs and the other tests of the core, up
//! to the first that fails. A run that fails, crashes or does not end kills the mutant.
//!
//! Each outcome is added to `target/mutants/outcomes.txt` at once, so that nothing is lost if this is stopped: it goes on
//! where it was. Delete the lines of mutants that shall run again, and the file after a change of the core.

use std::fs;
use std::io::Write;
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
const LEFT_OUT: [&str; 3] = ["neon.rs", "wasm.rs", "software.rs"];
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
/// What a mutant has to survive: random inputs, and the tests of the core, the fastest first.
const RUNS: [(&str, &[&str]); 9] = [
    ("sweep_and_prune", &[]),
    (DRIVER, &["broad_phase", "--calls", "100000", "--threads", "1"]),
    (DRIVER, &["finder", "--calls", "500", "--threads", "1"]),
    (DRIVER, &["snapshot", "--calls", "50000", "--threads", "1"]),
    ("behavior", &["broad_phase", "errors::"]),
    ("behavior", &["pairs::", "--skip", "broad_phase"]),
    ("broad_phase_allocations", &[]),
    ("out_of_memory", &[]),
    ("pairs_memory", &[]),
];

/// How the outcome of a mutant that does not compile begins.
const UNCOMPILED: &str = "does not compile: ";

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

/// All files in a folder, without what was built there.
fn files(folder: &Path) -> Vec<PathBuf> {
    if !folder.is_dir() {
        return vec![folder.to_path_buf()];
    }
    let mut entries: Vec<_> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    entries.retain(|path| !path.ends_with("target") && !path.ends_with("mutants"));
    entries.iter().flat_map(|path| files(path)).collect()
}

/// Writes a file unless it holds that already: cargo builds again what was written.
fn write(path: &Path, text: impl AsRef<[u8]>) {
    if fs::read(path).ok().as_deref() != Some(text.as_ref()) {
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
}

/// Whether a file of the repository is mutated.
fn is_mutated(name: &Path) -> bool {
    MUTATED.iter().any(|folder| name.starts_with(Path::new("core/src").join(folder)))
        && !LEFT_OUT.iter().any(|part| name.ends_with(part))
}

/// Writes the mutated sources. Returns what each mutant does.
fn mutate(root: &Path, copy: &Path, skipped: &[usize]) -> Vec<String> {
    let mut mutants = Vec::new();
    for file in files(&root.join("core/src")) {
        let name = file.strip_prefix(root).unwrap();
        if is_mutated(name) {
            let mut source = syn::parse_file(&fs::read_to_string(&file).unwrap()).unwrap();
            let file = name.display().to_string();
            Mutator { file, mutants: &mut mutants, skipped }.visit_file_mut(&mut source);
            write(&copy.join(name), prettyplease::unparse(&source));
        }
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
    for file in COPIED.iter().flat_map(|name| files(&root.join(name))) {
        let name = file.strip_prefix(root).unwrap();
        let mut text = fs::read(&file).unwrap();
        if name.ends_with("core/src/lib.rs") {
            text.extend(MUTANTS.bytes());
        }
        if !is_mutated(name) {
            write(&copy.join(name), text);
        }
    }
    let manifest = fs::read_to_string(root.join("Cargo.toml")).unwrap();
    let sections = manifest.split("\n\n").filter(|section| {
        !section.contains("lints")
            && !section.contains("checked.package.sweep-and-prune-algorithms")
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
    write(&copy.join("Cargo.toml"), manifest);
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

/// Builds a program in the copy, and makes sure that it passes without a mutant.
fn prepare(copy: &Path, (name, arguments): (&'static str, &'static [&'static str])) -> Run {
    let test = ["test", "--no-run", "--package", "sweep-and-prune"];
    let (said, is_right) = match name {
        DRIVER => cargo(copy, &["build", "--package", DRIVER]),
        "sweep_and_prune" => cargo(copy, &[&test[..], &["--lib"]].concat()),
        name => cargo(copy, &[&test[..], &["--test", name]].concat()),
    };
    assert!(is_right, "the copy does not build:\n{said}");
    // "Executable tests/behavior/main.rs (target/checked/deps/behavior-0123456789abcdef)"
    let marker = format!("/{name}-");
    let test = said.lines().find(|line| line.contains(&marker));
    let test = test.and_then(|line| Some(line.trim_end().strip_suffix(')')?.rsplit_once('(')?.1));
    let program = copy.join(test.unwrap_or("target/checked/sweep-and-prune-fuzz"));
    let mut run = Run { name, program, arguments, folder: copy.join("core"), seconds: 3600 };
    let begun = Instant::now();
    assert_eq!(run.killer(None), None, "{name} fails without a mutant");
    println!("{name} {arguments:?}: {:.1} s", begun.elapsed().as_secs_f64());
    run.seconds = 5 + 4 * begun.elapsed().as_secs();
    run
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
    /// What kills a mutant, if it does not pass: random inputs, a test by its name, a crash, or too long a time.
    fn killer(&self, mutant: Option<usize>) -> Option<String> {
        let said = self.folder.with_file_name("said");
        let mut command = Command::new("sh");
        // A mutant may neither run nor allocate without end.
        command
            .args(["-c", r#"ulimit -t "$0"; ulimit -v 8000000; exec "$@""#])
            .arg(self.seconds.to_string())
            .arg(&self.program)
            .args(self.arguments)
            .current_dir(&self.folder)
            .stdin(Stdio::null())
            .stdout(fs::File::create(&said).unwrap())
            .stderr(Stdio::null());
        let is_test = self.name != DRIVER;
        if is_test {
            command.args(["--test-threads", "2"]);
        }
        if let Some(mutant) = mutant {
            command.env("MUTANT", mutant.to_string());
        }
        let mut child = command.spawn().unwrap();
        let begun = Instant::now();
        let failed = |text: String| {
            let line = text.lines().find_map(|line| line.strip_suffix(" ... FAILED"));
            line.filter(|_| is_test).map(|line| line.trim_start_matches("test ").to_string())
        };
        loop {
            let ended = child.try_wait().unwrap();
            let failed = failed(fs::read_to_string(&said).unwrap_or_default());
            // Threads that wait for each other take no processor time.
            let is_stuck = begun.elapsed() > 20 * Duration::from_secs(self.seconds);
            if ended.is_none() && (failed.is_some() || is_stuck) {
                let _ = child.kill();
                let _ = child.wait();
            }
            match (ended, failed) {
                (Some(status), _) if status.success() => return None,
                (_, Some(test)) => return Some(test),
                (Some(_), None) if !is_test => {
                    return Some(format!("random inputs: {}", self.arguments[0]));
                }
                (Some(status), None) => return Some(format!("{}: {status}", self.name)),
                (None, None) if is_stuck => return Some(format!("{}: does not end", self.name)),
                (None, None) => sleep(Duration::from_millis(20)),
            }
        }
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let numbers: Vec<u64> = arguments.iter().filter_map(|text| text.parse().ok()).collect();
    let (count, seed) = (numbers.first().unwrap_or(&200), *numbers.get(1).unwrap_or(&1));
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap();
    let folder = root.join("target/mutants");
    copy(root, &folder);
    // The last line about a mutant counts: "killed by ...: 12 core/src/pairs/brute.rs:28: && instead of ||", how many
    // runs it survives, or that it does not compile.
    let path = folder.join("outcomes.txt");
    let known = fs::read_to_string(&path).unwrap_or_default();
    let mut file = fs::OpenOptions::new().create(true).append(true).open(&path).unwrap();
    let uncompiled = known.lines().filter_map(|line| line.strip_prefix(UNCOMPILED));
    let mut skipped: Vec<usize> =
        uncompiled.filter_map(|name| name.split(' ').next()?.parse().ok()).collect();
    let mutants = loop {
        let mutants = mutate(root, &folder, &skipped);
        println!("{} mutants, {} of them do not compile", mutants.len(), skipped.len());
        match &culprits(&folder)[..] {
            [] => break mutants,
            more => {
                for &mutant in more {
                    writeln!(file, "{UNCOMPILED}{mutant} {}", mutants[mutant]).unwrap();
                }
                skipped.extend(more);
            }
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
    if numbers.len() < arguments.len() {
        sample = left;
        sample.retain(|&id| arguments.iter().any(|name| mutants[id].ends_with(name)));
    } else {
        while sample.len() < *count as usize && !left.is_empty() {
            sample.push(left.swap_remove((random() % left.len() as u64) as usize));
        }
    }

    let name = |mutant: usize| format!(": {mutant} {}", mutants[mutant]);
    let outcome = |&mutant: &usize| {
        let line = known.lines().rev().find_map(|line| line.strip_suffix(&name(mutant)));
        line.unwrap_or("survives 0 runs").to_string()
    };
    let mut outcomes: Vec<_> = sample.iter().map(outcome).collect();
    for (number, &run) in RUNS.iter().enumerate() {
        let survived = format!("survives {number} runs");
        let left = || sample.iter().zip(&outcomes).filter(|(_, outcome)| **outcome == survived);
        println!("{} mutants survive {number} runs", left().count());
        if left().count() == 0 {
            continue;
        }
        let run = prepare(&folder, run);
        for (&mutant, outcome) in sample.iter().zip(&mut outcomes) {
            if *outcome == survived {
                *outcome = match run.killer(Some(mutant)) {
                    Some(killer) => format!("killed by {killer}"),
                    None => format!("survives {} runs", number + 1),
                };
                writeln!(file, "{outcome}{}", name(mutant)).unwrap();
            }
        }
    }
    let count = |how: &str| outcomes.iter().filter(|outcome| outcome.starts_with(how)).count();
    let (killed, random) = (count("killed by"), count("killed by random inputs"));
    println!(
        "{} mutants: {random} killed by random inputs, {} by the tests, {} survive: {}",
        outcomes.len(),
        killed - random,
        count("survives"),
        path.display()
    );
    for (&mutant, outcome) in sample.iter().zip(&outcomes) {
        if outcome.starts_with("survives") {
            println!("SURVIVES{}", name(mutant));
        }
    }
}
