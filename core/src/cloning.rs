//! Copies into memory that is there.

/// `Clone` of a type, field by field. Where it is derived, `clone_from` makes a new copy; here each field keeps its memory.
macro_rules! clone_fields {
    ([$($generics:tt)*] $name:ty { $($field:ident),* $(,)? }) => {
        impl<$($generics)*> Clone for $name {
            #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
            fn clone(&self) -> Self {
                let Self { $($field),* } = self;
                Self { $($field: $field.clone()),* }
            }

            #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
            fn clone_from(&mut self, source: &Self) {
                let Self { $($field),* } = source;
                $(self.$field.clone_from($field);)*
            }
        }
    };
}

pub(crate) use clone_fields;
