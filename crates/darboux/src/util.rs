//! Containers and sorting: small replacements for parts of the standard library, each with its reason.

pub(crate) mod hash_map;
pub(crate) mod radix_sort;
