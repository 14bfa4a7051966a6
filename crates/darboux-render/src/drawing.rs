//! What one drawing shows: a model, or two side by side, from one camera.

use crate::camera::ViewTransform;
use crate::model::Model;
use crate::options::{Mistakes, RenderOptions, View};
use crate::subject::Subject;

/// One side of a picture.
#[derive(Clone, Copy)]
pub struct Side<'a> {
    /// The model, with its tangents.
    pub model: &'a Model<'a>,
    /// The mistakes that are made with it.
    pub mistakes: Mistakes,
}

/// A drawing of the surface or the UV layout.
pub struct Drawing<'a> {
    pub left: Side<'a>,
    /// The right side, and the fraction of the width at which it begins.
    pub right: Option<(Side<'a>, f64)>,
    pub subject: Subject,
    pub size: [u32; 2],
    pub transform: ViewTransform,
    pub options: &'a RenderOptions,
}

impl<'a> Drawing<'a> {
    /// What the surface is coloured with.
    pub fn view(&self) -> View {
        match (self.subject, self.options.view) {
            (Subject::UvLayout, view) if view.is_lit() => View::Sign,
            (_, view) => view,
        }
    }

    /// The visible sides, each with its first column of pixels and its number of columns.
    pub fn sides(&self) -> Vec<(Side<'a>, [u32; 2])> {
        let width = self.size[0];
        let Some((right, fraction)) = self.right else { return vec![(self.left, [0, width])] };
        let middle = (f64::from(width) * fraction.clamp(0.0, 1.0)).round() as u32;
        let sides = [(self.left, [0, middle]), (right, [middle, width - middle])];
        sides.into_iter().filter(|(_, [_, columns])| *columns > 0).collect()
    }
}
