//! Containers and sorting that the algorithms share.

pub(crate) mod hash_map;
pub(crate) mod radix_sort;
pub(crate) mod random;
pub(crate) mod union_find;
