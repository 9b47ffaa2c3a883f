//! The arithmetic on coordinates, at the limits of their types.

use super::*;

#[test]
fn keys_sort_as_coordinates_do() {
    let ascending = [f32::NEG_INFINITY, -1e30, -1.0, -1e-40, 0.0, 1e-40, 1.0, 1e30, f32::INFINITY];
    for pair in ascending.windows(2) {
        assert!(Ieee754::key(pair[0], 9) < Ieee754::key(pair[1], 0));
        let [low, high] = [pair[0], pair[1]].map(f64::from);
        assert!(Ieee754::key(low, 9) < Ieee754::key(high, 0));
    }
    assert_eq!(Ieee754::key(-0.0f32, 3), Ieee754::key(0.0f32, 3));
    let key = Ieee754::key(-7.0f64, u32::MAX);
    assert_eq!(<Ieee754 as Arithmetic<f64>>::position(key), u32::MAX);
}

#[test]
fn cells_are_monotone_for_all_coordinates() {
    let ascending = [
        f64::NEG_INFINITY,
        f64::MIN,
        -1e30,
        -1.0,
        -1e-320,
        0.0,
        0.3,
        1.0,
        1e30,
        f64::MAX,
        f64::INFINITY,
    ];
    for origin in [-1e300, -1.0, 0.0, 1e-320, 1e300] {
        for scale in [0.0, 1e-300, 1.0, 1e300, f64::INFINITY] {
            let quantizer = Quantizer { unit: 1.0, origin, scale, last: 100.0 };
            let cells = ascending.map(|x| Ieee754::cell(x, &quantizer));
            assert!(cells.is_sorted() && cells[10] <= 100, "{origin} {scale} {cells:?}");
        }
    }
    let quantizer = Quantizer { unit: 1.0, origin: 0.0, scale: 1.0, last: 7.0 };
    assert_eq!([0.4f32, 0.6, 4.6, 9.0].map(|x| Ieee754::cell(x, &quantizer)), [0, 1, 5, 7]);
}
