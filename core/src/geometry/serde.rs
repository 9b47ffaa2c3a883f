//! serde: a box is the struct `{ min, max }`, each corner a tuple of `D` coordinates.

use core::fmt;

use serde::de::{self, Deserialize, Deserializer, SeqAccess, Visitor};
use serde::ser::{Serialize, SerializeTuple, Serializer};

use super::{Aabb, Scalar};

impl<const D: usize, T: Scalar + Serialize> Serialize for Aabb<D, T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Corners { min: Corner(self.min), max: Corner(self.max) }.serialize(serializer)
    }
}

/// Any coordinates are accepted, as by [`Aabb::new`].
impl<'de, const D: usize, T: Scalar + Deserialize<'de>> Deserialize<'de> for Aabb<D, T> {
    fn deserialize<S: Deserializer<'de>>(deserializer: S) -> Result<Self, S::Error> {
        let Corners { min: Corner(min), max: Corner(max) } = Corners::deserialize(deserializer)?;
        Ok(Self { min, max })
    }
}

#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename = "Aabb", deny_unknown_fields)]
#[serde(bound(serialize = "T: Serialize", deserialize = "T: Scalar + Deserialize<'de>"))]
struct Corners<const D: usize, T> {
    min: Corner<D, T>,
    max: Corner<D, T>,
}

/// An array of any length, which serde itself does not support.
struct Corner<const D: usize, T>([T; D]);

impl<const D: usize, T: Serialize> Serialize for Corner<D, T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut tuple = serializer.serialize_tuple(D)?;
        for coordinate in &self.0 {
            tuple.serialize_element(coordinate)?;
        }
        tuple.end()
    }
}

impl<'de, const D: usize, T: Scalar + Deserialize<'de>> Deserialize<'de> for Corner<D, T> {
    fn deserialize<S: Deserializer<'de>>(deserializer: S) -> Result<Self, S::Error> {
        deserializer.deserialize_tuple(D, CornerVisitor([T::default(); D])).map(Corner)
    }
}

/// Replaces the coordinates that it holds by those that it reads.
struct CornerVisitor<const D: usize, T>([T; D]);

impl<'de, const D: usize, T: Scalar + Deserialize<'de>> Visitor<'de> for CornerVisitor<D, T> {
    type Value = [T; D];

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{D} coordinates")
    }

    fn visit_seq<A: SeqAccess<'de>>(mut self, mut sequence: A) -> Result<[T; D], A::Error> {
        for (axis, coordinate) in self.0.iter_mut().enumerate() {
            *coordinate = sequence
                .next_element()?
                .ok_or_else(|| de::Error::invalid_length(axis, &"one coordinate for each axis"))?;
        }
        Ok(self.0)
    }
}
