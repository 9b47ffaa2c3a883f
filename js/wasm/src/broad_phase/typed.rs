//! A world of any type: its boxes are made of numbers, and its answers numbers.

use alloc::boxed::Box;
use alloc::vec::Vec;

use sweep_and_prune::{Aabb, BroadPhase, Cast, Error, Filter, Options, ProxyId, Report, Scalar};

use super::handle::to_number;

/// Which bodies a query asks about, and in which form it answers.
#[derive(Clone, Copy)]
pub(super) enum Query {
    /// A box; ids.
    Overlapping,
    /// A point; ids.
    Containing,
    /// A centre and a radius; ids.
    Within,
    /// A box, a direction and a limit; the id and the place of the first hit.
    Cast,
    /// The same; the ids and places of all.
    CastAll,
    /// A point; the ids and squared distances of so many.
    Nearest(usize),
}

/// The numbers that go in and out: two boxes and more.
pub(super) type Numbers = [f64; 16];

/// A world of any type, with what goes in and comes out.
pub(super) trait World {
    fn rows(&mut self, count: usize) -> Option<*mut u8>;
    fn insert(&mut self, numbers: &Numbers) -> Result<ProxyId, Error>;
    fn insert_many(&mut self, count: usize, filter: Filter) -> Result<Vec<ProxyId>, Error>;
    fn set(&mut self, id: ProxyId, numbers: &Numbers) -> Result<(), Error>;
    fn set_many(&mut self, ids: &[ProxyId]) -> Result<(), Error>;
    fn set_swept(&mut self, id: ProxyId, numbers: &Numbers) -> Result<(), Error>;
    fn set_filter(&mut self, id: ProxyId, filter: Filter) -> Result<(), Error>;
    fn filter(&self, id: ProxyId) -> Result<Filter, Error>;
    fn aabb(&self, id: ProxyId, numbers: &mut Numbers) -> Result<(), Error>;
    fn remove_many(&mut self, ids: &[ProxyId]) -> Result<(), Error>;
    /// Begun and then ended pairs; returns how many numbers the begun ones are.
    fn update(&mut self, out: &mut Vec<f64>) -> usize;
    fn pairs(&self, out: &mut Vec<f64>);
    fn pairs_of(&mut self, id: ProxyId, out: &mut Vec<f64>) -> Result<(), Error>;
    fn ids(&self, each: &mut dyn FnMut(ProxyId));
    fn len(&self) -> usize;
    fn query(
        &mut self,
        query: Query,
        filter: Filter,
        numbers: &Numbers,
        out: &mut Vec<f64>,
    ) -> Result<(), Error>;
    fn snapshot(&self) -> Vec<u8>;
    fn restore(&mut self, bytes: &[u8]) -> Result<(), Error>;
    fn hash(&self) -> u64;
}

pub(super) struct Typed<const D: usize, T: Scalar> {
    world: BroadPhase<D, T>,
    rows: Vec<Aabb<D, T>>,
}

impl<const D: usize, T: Scalar> Typed<D, T> {
    pub fn boxed(margin: f64, prediction: f64, report: Report) -> Option<Box<dyn World>> {
        let (margin, prediction) = (T::from_f64(margin), T::from_f64(prediction));
        let world = BroadPhase::with_options(Options { margin, prediction, report }).ok()?;
        Some(Box::new(Self { world, rows: Vec::new() }))
    }

    fn point(numbers: &Numbers, from: usize) -> [T; D] {
        core::array::from_fn(|axis| T::from_f64(numbers[from + axis]))
    }

    fn boxed_at(numbers: &Numbers, from: usize) -> Aabb<D, T> {
        Aabb::new(Self::point(numbers, from), Self::point(numbers, from + D))
    }
}

impl<const D: usize, T: Scalar> World for Typed<D, T> {
    fn rows(&mut self, count: usize) -> Option<*mut u8> {
        if let Some(more) = count.checked_sub(self.rows.len()) {
            self.rows.try_reserve(more).ok()?;
            self.rows.resize(count, Aabb::new([T::default(); D], [T::default(); D]));
        }
        Some(self.rows.as_mut_ptr().cast())
    }

    fn insert(&mut self, numbers: &Numbers) -> Result<ProxyId, Error> {
        self.world.insert(Self::boxed_at(numbers, 0))
    }

    fn insert_many(&mut self, count: usize, filter: Filter) -> Result<Vec<ProxyId>, Error> {
        self.world.insert_many(&self.rows[..count.min(self.rows.len())], filter)
    }

    fn set(&mut self, id: ProxyId, numbers: &Numbers) -> Result<(), Error> {
        self.world.set(id, Self::boxed_at(numbers, 0))
    }

    fn set_many(&mut self, ids: &[ProxyId]) -> Result<(), Error> {
        self.world.set_many(ids, &self.rows[..ids.len().min(self.rows.len())])
    }

    fn set_swept(&mut self, id: ProxyId, numbers: &Numbers) -> Result<(), Error> {
        self.world.set_swept(id, Self::boxed_at(numbers, 0), Self::boxed_at(numbers, 2 * D))
    }

    fn set_filter(&mut self, id: ProxyId, filter: Filter) -> Result<(), Error> {
        self.world.set_filter(id, filter)
    }

    fn filter(&self, id: ProxyId) -> Result<Filter, Error> {
        self.world.filter(id)
    }

    fn aabb(&self, id: ProxyId, numbers: &mut Numbers) -> Result<(), Error> {
        let aabb = self.world.aabb(id)?;
        for (number, at) in numbers.iter_mut().zip(aabb.min.into_iter().chain(aabb.max)) {
            *number = at.to_f64();
        }
        Ok(())
    }

    fn remove_many(&mut self, ids: &[ProxyId]) -> Result<(), Error> {
        self.world.remove_many(ids)
    }

    fn update(&mut self, out: &mut Vec<f64>) -> usize {
        let changes = self.world.update();
        out.extend(changes.begun().flatten().map(to_number));
        let begun = out.len();
        out.extend(changes.ended().flatten().map(to_number));
        begun
    }

    fn pairs(&self, out: &mut Vec<f64>) {
        out.extend(self.world.pairs().into_iter().flatten().map(to_number));
    }

    fn pairs_of(&mut self, id: ProxyId, out: &mut Vec<f64>) -> Result<(), Error> {
        out.extend(self.world.pairs_of(id)?.into_iter().map(to_number));
        Ok(())
    }

    fn ids(&self, each: &mut dyn FnMut(ProxyId)) {
        self.world.ids().for_each(each);
    }

    fn len(&self) -> usize {
        self.world.len()
    }

    fn query(
        &mut self,
        query: Query,
        filter: Filter,
        numbers: &Numbers,
        out: &mut Vec<f64>,
    ) -> Result<(), Error> {
        let queries = self.world.queries();
        // These words stand for a query without a filter, which finds all bodies.
        let queries = if filter == Filter::ALL { queries } else { queries.with_filter(filter) };
        let point = Self::point(numbers, 0);
        let ids = match query {
            Query::Overlapping => queries.overlapping(&Self::boxed_at(numbers, 0))?,
            Query::Containing => queries.containing(point)?,
            Query::Within => queries.within(point, T::from_f64(numbers[D]))?,
            Query::Cast | Query::CastAll => {
                let direction = Self::point(numbers, 2 * D);
                let limit = T::from_f64(numbers[3 * D]);
                let cast = Cast::aabb(Self::boxed_at(numbers, 0), direction, limit);
                if matches!(query, Query::Cast) {
                    out.extend(
                        queries.cast(&cast)?.iter().flat_map(|hit| [to_number(hit.id), hit.at]),
                    );
                } else {
                    let hits = queries.cast_all(&cast)?;
                    out.extend(hits.iter().flat_map(|hit| [to_number(hit.id), hit.at]));
                }
                return Ok(());
            }
            Query::Nearest(k) => {
                let nearest = queries.nearest(point, k)?;
                out.extend(
                    nearest.iter().flat_map(|near| [to_number(near.id), near.distance_squared]),
                );
                return Ok(());
            }
        };
        out.extend(ids.into_iter().map(to_number));
        Ok(())
    }

    fn snapshot(&self) -> Vec<u8> {
        self.world.snapshot()
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<(), Error> {
        self.world = BroadPhase::from_snapshot(bytes)?;
        Ok(())
    }

    fn hash(&self) -> u64 {
        self.world.state_hash()
    }
}
