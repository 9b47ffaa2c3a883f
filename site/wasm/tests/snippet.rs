//! What the playground writes down in Rust compiles and finds what it says. That the page writes
//! exactly this file is tested in `site/test/playground.spec.ts`.

include!("../../test/snippets/playground.rs");

#[test]
fn finds_the_pairs_it_says() {
    let text = include_str!("../../test/snippets/playground.rs");
    let said = text.split("pairs.len()); // ").nth(1).and_then(|rest| rest.lines().next());
    let boxes: Vec<Aabb<2>> = BOXES.iter().map(|&(min, max)| Aabb::new(min, max)).collect();
    assert_eq!(said.unwrap(), find_pairs(&boxes).unwrap().len().to_string());
    main().unwrap();
}
