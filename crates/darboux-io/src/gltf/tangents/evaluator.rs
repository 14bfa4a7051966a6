//! The base's tangents again, after its vertices moved.

use darboux::{CornerTangents, Mesh, MeshError, Method, Plan, TangentOptions, Tangents, generate_tangents};

/// What evaluates morph targets of one mesh.
#[derive(Debug)]
pub enum Evaluator {
    /// In the base's groups.
    Planned(Box<Plan>),
    /// Anew: the vertices and UVs decide the groups of these methods, but for `AngleArea`, whose weld is found again.
    Fresh(TangentOptions),
}

impl Evaluator {
    /// The tangents of the base, and what evaluates them again.
    pub fn new(mesh: &Mesh<'_>, options: &TangentOptions) -> (Tangents, Self) {
        if options.method == Method::MikkTSpace {
            let plan = Plan::new(mesh, options);
            (plan.base().clone(), Self::Planned(Box::new(plan)))
        } else {
            (generate_tangents(mesh, options), Self::Fresh(*options))
        }
    }

    /// Tangents of the moved mesh, and how many of its corners a fresh run would give others.
    ///
    /// `mesh`: the base's faces, indices and UVs. Errors: another number of corners or vertices.
    pub fn evaluate(&self, mesh: &Mesh<'_>) -> Result<(CornerTangents, usize), MeshError> {
        match self {
            Self::Planned(plan) => Ok((plan.evaluate(mesh)?, plan.count_regrouped(mesh)?)),
            Self::Fresh(options) => Ok((generate_tangents(mesh, options).corners, 0)),
        }
    }
}
