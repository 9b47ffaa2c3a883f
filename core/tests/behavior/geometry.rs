//! Boxes: what overlaps, what is valid, centers and sizes, conversions from and to arrays, tuples and the types of other crates.

use sweep_and_prune::{Aabb, Error, Scalar, Value, validate};

#[test]
fn a_box_has_a_center_and_full_and_half_extents() {
    let aabb = Aabb::new([0.0f32, -2.0, 5.0], [1.0, 4.0, 5.0]);
    assert_eq!(aabb.center(), [0.5, 1.0, 5.0]);
    assert_eq!(aabb.extents(), [1.0, 6.0, 0.0]);
    assert_eq!(aabb.half_extents(), [0.5, 3.0, 0.0]);
    assert_eq!(Aabb::from_center(aabb.center(), aabb.half_extents()), aabb);
    assert!(!Aabb::from_center([0.0f32], [-1.0]).is_valid());
    let huge = Aabb::new([-f32::MAX], [f32::MAX]);
    assert_eq!(Aabb::from_center(huge.center(), huge.half_extents()), huge);
}

#[test]
fn the_center_neither_overflows_nor_underflows() {
    fn check<T: Scalar>(largest: T, smallest: T) {
        assert_eq!(Aabb::new([largest], [largest]).center(), [largest]);
        assert_eq!(Aabb::new([smallest], [smallest]).center(), [smallest]);
        assert_eq!(Aabb::new([T::default()], [T::INFINITY]).center(), [T::INFINITY]);
        let [center] = Aabb::new([T::NEG_INFINITY], [T::INFINITY]).center();
        assert!(center.to_f64().is_nan());
    }
    check(f32::MAX, f32::from_bits(1));
    check(f64::MAX, f64::from_bits(1));
}

#[test]
fn arrays_and_tuples_convert_to_boxes_and_back() {
    let line = Aabb::new([1.0f32], [2.0]);
    assert_eq!(Aabb::from([1.0, 2.0]), line);
    assert_eq!(<[f32; 2]>::from(line), [1.0, 2.0]);

    let flat = [1.0f64, 2.0, 3.0, 4.0];
    let rectangle = Aabb::new([1.0f64, 2.0], [3.0, 4.0]);
    assert_eq!(Aabb::from(flat), rectangle);
    assert_eq!(<[f64; 4]>::from(rectangle), flat);

    let flat = [1.0f32, 2.0, 3.0, 4.0, 5.0, 6.0];
    let cuboid = Aabb::new([1.0f32, 2.0, 3.0], [4.0, 5.0, 6.0]);
    assert_eq!(Aabb::from(flat), cuboid);
    assert_eq!(<[f32; 6]>::from(cuboid), flat);

    assert_eq!(Aabb::from([[1.0f32, 2.0, 3.0], [4.0, 5.0, 6.0]]), cuboid);
    assert_eq!(<[[f32; 3]; 2]>::from(cuboid), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    assert_eq!(Aabb::from(([1.0f32, 2.0, 3.0], [4.0, 5.0, 6.0])), cuboid);
    assert_eq!(<([f32; 3], [f32; 3])>::from(cuboid), ([1.0, 2.0, 3.0], [4.0, 5.0, 6.0]));
}

/// Asserts that corners of type `V` convert to the box and back, as a tuple and as an array.
#[cfg(any(feature = "glam030", feature = "glam034", feature = "mint"))]
fn corners_convert<const D: usize, T, V>(min: V, max: V, aabb: Aabb<D, T>)
where
    T: Scalar,
    V: Copy + PartialEq + core::fmt::Debug,
    Aabb<D, T>: From<(V, V)> + From<[V; 2]> + Into<(V, V)> + Into<[V; 2]>,
{
    assert_eq!(Aabb::from((min, max)), aabb);
    assert_eq!(Aabb::from([min, max]), aabb);
    let tuple: (V, V) = aabb.into();
    let array: [V; 2] = aabb.into();
    assert_eq!((tuple, array), ((min, max), [min, max]));
}

/// The test of each version of glam.
macro_rules! glam_test {
    ($($feature:literal, $glam:ident;)*) => {$(
        #[cfg(feature = $feature)]
        #[test]
        fn $glam() {
        use $glam::{DVec2, DVec3, Vec2, Vec3, Vec3A};

            corners_convert(Vec2::new(0., 1.), Vec2::new(2., 3.), Aabb::new([0., 1.], [2., 3.]));
            corners_convert(DVec2::new(0., 1.), DVec2::new(2., 3.), Aabb::new([0., 1.], [2., 3.]));
            let cuboid = Aabb::new([0., 1., 2.], [3., 4., 5.]);
            corners_convert(Vec3::new(0., 1., 2.), Vec3::new(3., 4., 5.), cuboid);
            corners_convert(Vec3A::new(0., 1., 2.), Vec3A::new(3., 4., 5.), cuboid);
            let cuboid = Aabb::new([0., 1., 2.], [3., 4., 5.]);
            corners_convert(DVec3::new(0., 1., 2.), DVec3::new(3., 4., 5.), cuboid);

            let ball = Aabb::from_center(Vec3::ONE.into(), Vec3::splat(0.5).into());
            assert_eq!(ball, Aabb::new([0.5; 3], [1.5; 3]));
        }
    )*};
}

mod glam_vectors_convert_to_boxes_and_back {
    #[allow(unused_imports, reason = "without a feature there is no test")]
    use super::*;

    glam_test! {
        "glam030", glam030;
        "glam031", glam031;
        "glam032", glam032;
        "glam033", glam033;
        "glam034", glam034;
    }
}

#[cfg(feature = "mint")]
#[test]
fn mint_points_and_vectors_convert_to_boxes_and_back() {
    use mint::{Point2, Point3, Vector2, Vector3};

    fn check<T: Scalar>([a, b, c, d, e, f]: [T; 6])
    where
        Aabb<2, T>: From<(Point2<T>, Point2<T>)> + From<[Point2<T>; 2]>,
        Aabb<2, T>: Into<(Point2<T>, Point2<T>)> + Into<[Point2<T>; 2]>,
        Aabb<2, T>: From<(Vector2<T>, Vector2<T>)> + From<[Vector2<T>; 2]>,
        Aabb<2, T>: Into<(Vector2<T>, Vector2<T>)> + Into<[Vector2<T>; 2]>,
        Aabb<3, T>: From<(Point3<T>, Point3<T>)> + From<[Point3<T>; 2]>,
        Aabb<3, T>: Into<(Point3<T>, Point3<T>)> + Into<[Point3<T>; 2]>,
        Aabb<3, T>: From<(Vector3<T>, Vector3<T>)> + From<[Vector3<T>; 2]>,
        Aabb<3, T>: Into<(Vector3<T>, Vector3<T>)> + Into<[Vector3<T>; 2]>,
    {
        let rectangle = Aabb::new([a, b], [c, d]);
        corners_convert(Point2 { x: a, y: b }, Point2 { x: c, y: d }, rectangle);
        corners_convert(Vector2 { x: a, y: b }, Vector2 { x: c, y: d }, rectangle);
        let cuboid = Aabb::new([a, b, c], [d, e, f]);
        corners_convert(Point3 { x: a, y: b, z: c }, Point3 { x: d, y: e, z: f }, cuboid);
        corners_convert(Vector3 { x: a, y: b, z: c }, Vector3 { x: d, y: e, z: f }, cuboid);
    }
    check([0.0f32, 1.0, 2.0, 3.0, 4.0, 5.0]);
    check([0.0f64, 1.0, 2.0, 3.0, 4.0, 5.0]);
}

#[cfg(feature = "bytemuck")]
#[test]
fn a_slice_of_coordinates_is_cast_to_boxes_without_a_copy() {
    let mut coordinates = [0.0f32, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
    let boxes: &[Aabb<2>] = bytemuck::cast_slice(&coordinates);
    assert_eq!(boxes, [Aabb::new([0.0, 1.0], [2.0, 3.0]), Aabb::new([4.0, 5.0], [6.0, 7.0])]);
    assert_eq!(boxes.as_ptr().cast(), coordinates.as_ptr());
    assert_eq!(bytemuck::cast_slice::<_, f32>(boxes), coordinates);

    let boxes: &mut [Aabb<2>] = bytemuck::cast_slice_mut(&mut coordinates);
    boxes[1].max[0] = 9.0;
    assert_eq!(coordinates[6], 9.0);
    assert_eq!(bytemuck::bytes_of(&Aabb::new([1.0f64], [2.0])).len(), 16);
    let zeroed: Aabb<3, f64> = bytemuck::Zeroable::zeroed();
    assert_eq!(zeroed, Aabb::new([0.0; 3], [0.0; 3]));
}

#[cfg(feature = "serde")]
#[test]
fn a_box_is_its_two_corners_in_json() {
    let aabb = Aabb::new([0.0f32, 1.5], [2.0, 3.0]);
    let json = serde_json::to_string(&aabb).unwrap();
    assert_eq!(json, r#"{"min":[0.0,1.5],"max":[2.0,3.0]}"#);
    assert_eq!(serde_json::from_str::<Aabb<2>>(&json).unwrap(), aabb);
    for wrong in [
        r#"{"min":[0.0],"max":[2.0,3.0]}"#,
        r#"{"min":[0.0,1.0,2.0],"max":[2.0,3.0]}"#,
        r#"{"min":[0.0,1.0]}"#,
        r#"{"min":[0.0,1.0],"max":[2.0,3.0],"id":3}"#,
    ] {
        assert!(serde_json::from_str::<Aabb<2>>(wrong).is_err(), "{wrong}");
    }
}

#[test]
fn touching_boxes_overlap_and_negative_zero_is_zero() {
    let a = Aabb::new([0.0f32], [0.0]);
    let b = Aabb::new([-0.0f32], [-0.0]);
    let c = Aabb::new([0.0f32], [1.0]);
    assert!(a.overlaps(&b) && b.overlaps(&c) && c.overlaps(&a));
}

#[test]
fn infinite_boxes_overlap_what_they_should() {
    let inf = f64::INFINITY;
    let everything = Aabb::new([-inf, -inf], [inf, inf]);
    let point_at_infinity = Aabb::new([inf, inf], [inf, inf]);
    let point = Aabb::new([3.0, 4.0], [3.0, 4.0]);
    assert!(everything.is_valid() && point_at_infinity.is_valid());
    assert!(everything.overlaps(&point_at_infinity));
    assert!(everything.overlaps(&point));
    assert!(!point.overlaps(&point_at_infinity));
}

#[test]
fn validation_names_the_box_and_the_axis() {
    let good = Aabb::new([0.0f32, 0.0], [1.0, 1.0]);
    let nan = Aabb::new([0.0f32, f32::NAN], [1.0, 1.0]);
    let inverted = Aabb::new([2.0f32, 0.0], [1.0, 1.0]);
    assert_eq!(validate(&[good, good]), Ok(()));
    let [zero, one, two, nan_value] = [0.0, 1.0, 2.0, f64::NAN].map(Value::from);
    let error = Error::InvalidBox { set: 0, index: 1, axis: 1, min: nan_value, max: one };
    assert_eq!(validate(&[good, nan]), Err(error));
    assert_ne!(error, Error::InvalidBox { set: 0, index: 1, axis: 1, min: zero, max: one });
    let error = Error::InvalidBox { set: 0, index: 2, axis: 0, min: two, max: one };
    assert_eq!(validate(&[good, good, inverted]), Err(error));
}

#[test]
fn boxes_of_points_contain_each_and_nothing_beyond() {
    assert_eq!(Aabb::<2>::from_points([]), None);
    assert_eq!(Aabb::from_points([[3.0f32]]), Some(Aabb::new([3.0], [3.0])));
    let points = [[1.0f32, 5.0], [-2.0, 4.0], [0.5, 7.0], [0.0, -1.0]];
    assert_eq!(Aabb::from_points(points), Some(Aabb::new([-2.0, -1.0], [1.0, 7.0])));
    for bad in 0..4 {
        let mut points = points;
        points[bad][1] = f32::NAN;
        let aabb = Aabb::from_points(points).unwrap();
        assert_eq!(aabb.invalid_axis(), Some(1), "NaN in point {bad}");
    }
}

#[test]
fn intersections_are_what_both_contain() {
    let a = Aabb::new([0.0f64, 0.0], [2.0, 2.0]);
    for (b, expected) in [
        (Aabb::new([1.0, -1.0], [3.0, 1.0]), Some(Aabb::new([1.0, 0.0], [2.0, 1.0]))),
        (Aabb::new([-1.0, -1.0], [9.0, 9.0]), Some(a)),
        (Aabb::new([2.0, 0.5], [3.0, 1.0]), Some(Aabb::new([2.0, 0.5], [2.0, 1.0]))),
        (Aabb::new([2.5, 0.0], [3.0, 1.0]), None),
    ] {
        assert_eq!(a.intersection(&b), expected);
        assert_eq!(b.intersection(&a), expected);
    }
}

#[test]
fn boxes_grow_on_each_side_and_move_as_a_whole() {
    let aabb = Aabb::new([0.0f32, 1.0, 2.0], [2.0, 4.0, 8.0]);
    assert_eq!(aabb.grow(0.5), Aabb::new([-0.5, 0.5, 1.5], [2.5, 4.5, 8.5]));
    assert_eq!(aabb.grow(-1.5).invalid_axis(), Some(0));
    assert_eq!(aabb.translate([1.0, -1.0, 0.5]), Aabb::new([1.0, 0.0, 2.5], [3.0, 3.0, 8.5]));
}
