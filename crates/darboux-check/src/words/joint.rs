//! The words of two conventions that cancel: a mistake of a map and one of the tangents that use it.

use super::obstacles::names;
use super::tangents::name;
use crate::defect::{Cancelled, Defect};

/// What is said of a map that the tangents of all its surfaces cancel.
pub fn text(map: &Defect) -> String {
    let Some(Cancelled::BySurface { pair, first, are_several, is_of_most, recipe }) = &map.cancelled else {
        return String::new();
    };
    let [of_map, of_surface] = names(pair);
    let place = first.as_ref().map_or("the model".to_owned(), ToString::to_string);
    let further = if *are_several { " and of all others that use the map" } else { "" };
    let most = if *is_of_most { "nearly all of the area of " } else { "" };
    let most_of_them = if *is_of_most { ", on this part of the area, and inverted on the rest" } else { "" };
    let program = recipe.map_or_else(String::new, |recipe| {
        format!(", by a program that computes tangents by {}", name(&recipe))
    });
    format!(
        "two conventions cancel: {of_map} of the map, and {of_surface} of {most}{place}{further}, as after a \
         conversion that turned the UVs upside down and kept the map (from FBX or Unreal){program}; bumps \
         look right where the tangents of the file are used{most_of_them}"
    )
}
