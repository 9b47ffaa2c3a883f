//! Prints what belongs into golden.txt, after a change that is meant to change scenes:
//! `cargo run -p sweep-and-prune-scenes --example golden > scenes/golden.txt`

fn main() {
    print!("{}", sweep_and_prune_scenes::golden_report());
}
