//! Options are set one after the other, by methods with the names of their fields.

/// Methods that return the same options, or the same filter, with another value of a field.
macro_rules! setters {
    ($($field:ident: $type:ty),*) => {$(
        #[doc = concat!(
            "The same with another [`", stringify!($field), "`](Self#structfield.",
            stringify!($field), ").",
        )]
        #[must_use]
        pub const fn $field(self, $field: $type) -> Self {
            Self { $field, ..self }
        }
    )*};
}

pub(crate) use setters;
