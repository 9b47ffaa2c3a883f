//! What the published crate contains.

#[test]
fn the_license_files_are_those_of_the_repository() {
    assert_eq!(include_str!("../../LICENSE-MIT"), include_str!("../../../LICENSE-MIT"));
    assert_eq!(include_str!("../../LICENSE-APACHE"), include_str!("../../../LICENSE-APACHE"));
}

#[test]
fn the_features_of_the_front_page_are_those_of_the_manifest() {
    let manifest = include_str!("../../Cargo.toml");
    let front_page = include_str!("../../README.md");
    let features = manifest.split("[features]").nth(1).unwrap().split("\n[").next().unwrap();
    let names = features.lines().filter_map(|line| line.split_once(" = ")).map(|(name, _)| name);
    for name in names.filter(|&name| name != "default" && !name.starts_with('#')) {
        assert!(front_page.contains(&format!("| `{name}` |")), "{name}");
    }
}
