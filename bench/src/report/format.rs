//! Numbers as people read them.

/// Three significant digits and the unit.
pub fn time(nanoseconds: f64) -> String {
    let (number, unit) = match nanoseconds {
        ns if ns < 1e3 => (ns, "ns"),
        ns if ns < 1e6 => (ns / 1e3, "µs"),
        ns if ns < 1e9 => (ns / 1e6, "ms"),
        ns => (ns / 1e9, "s"),
    };
    format!("{} {unit}", significant(number))
}

/// Three significant digits, but never fewer than those before the point.
pub fn significant(number: f64) -> String {
    let digits = match number {
        n if n < 10.0 => 2,
        n if n < 100.0 => 1,
        _ => 0,
    };
    if digits == 0 { count(number.round() as u64) } else { format!("{number:.digits$}") }
}

/// To the nearest whole number.
pub fn rounded(number: f64) -> String {
    count(number.round() as u64)
}

/// A number with a comma every three digits.
pub fn count(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (at, digit) in digits.chars().enumerate() {
        if at > 0 && (digits.len() - at).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}
