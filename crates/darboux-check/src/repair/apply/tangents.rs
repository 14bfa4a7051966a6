//! Makes tangents again, or corrects those that are wrong.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::hash::{DefaultHasher, Hash, Hasher};

use darboux::{Context, TangentOptions};
use darboux_io::Error;
use darboux_io::gltf::{
    AddTangentsOptions, Document, Generate, GivenTangents, PrimitiveName, add_tangents_to,
};

use super::attributes::{check_rewritten, users_of};
use super::correction::{Correction, bits};
use crate::check::for_each_surface;
use crate::instances::{Groups, Key, key};
use crate::repair::options::FixOptions;
use crate::repair::outcome::Change;
use crate::repair::plan::{Kept, WrongTangents};

/// The attribute.
const TANGENT: &str = "TANGENT";

/// Corrects tangents that are wrong, and keeps the bits of the others. Vertices are split where their corners
/// need different tangents; on primitives with morph targets, all tangents and all tangent offsets of the
/// targets are then computed again. `wrong` and `kept`: per primitive. Returns what was done to the
/// primitives.
pub fn correct(
    document: &mut Document,
    wrong: &BTreeMap<Key, &WrongTangents>,
    kept: &BTreeMap<Key, Kept>,
    options: &FixOptions,
) -> Result<BTreeMap<Key, Change>, Error> {
    if wrong.is_empty() {
        return Ok(BTreeMap::new());
    }
    let mut corrections: Vec<Correction> = Vec::new();
    for_each_surface(document, &|name| wrong.contains_key(&key(name)), |surface| {
        let named = surface.place.primitive.as_ref().and_then(|name| wrong.get(&key(name)));
        corrections.extend(named.and_then(|wrong| Correction::new(surface, wrong, options)));
    })?;
    let groups = Groups::of(document, corrections.iter().map(|correction| &correction.surface.place));
    let (mut split, mut remade) = (Vec::new(), Vec::new());
    let mut of_accessors: BTreeMap<usize, Replacement> = BTreeMap::new();
    let mut changes = BTreeMap::new();
    for correction in corrections {
        let surface = &correction.surface;
        let names = groups.at(document, &surface.place);
        let change = Change::CorrectedTangents { count: correction.changed_count() };
        changes.extend(names.iter().map(|name| ((name.mesh, name.primitive), change)));
        match correction.of_vertices() {
            Some(of_vertices) => {
                for (accessor, users) in users_of(document, TANGENT, &names) {
                    of_accessors.entry(accessor).or_default().add(users, &of_vertices);
                }
            }
            None if has_targets(document, &names) => {
                let remade_names = names.iter().map(|name| (name.mesh, name.primitive));
                changes.extend(remade_names.map(|key| (key, Change::RecomputedTangents)));
                remade.extend(names);
            }
            None => split.push((names, correction)),
        }
    }
    let written = of_accessors
        .iter()
        .flat_map(|(&accessor, replacement)| replacement.groups.iter().map(move |_| accessor));
    check_rewritten::<4>(document, written)?;
    for (accessor, Replacement { groups, .. }) in of_accessors {
        let old = document.vectors::<4>(accessor)?.into_owned();
        for Rewritten { users, of_vertices } in groups {
            let mut tangents = old.clone();
            of_vertices.into_iter().for_each(|(vertex, tangent)| tangents[vertex] = tangent);
            document.set_tangents(&users, &tangents)?;
        }
    }
    split_vertices(document, &split)?;
    make(document, &remade, kept, options)?;
    Ok(changes)
}

/// Corrected tangents, by vertex.
type TangentOfVertex = BTreeMap<usize, [f32; 4]>;

/// Primitives that share an accessor, and their corrected tangents, which do not contradict each other.
struct Rewritten {
    users: Vec<PrimitiveName>,
    of_vertices: TangentOfVertex,
}

impl Rewritten {
    /// Whether no vertex has another tangent, by its bits.
    fn agrees_with(&self, tangents: &TangentOfVertex) -> bool {
        let is_same = |(vertex, tangent): (&usize, &[f32; 4])| {
            self.of_vertices.get(vertex).is_none_or(|other| bits(*other) == bits(*tangent))
        };
        tangents.iter().all(is_same)
    }
}

/// What takes the place of one accessor: an accessor for each group of primitives that agree.
#[derive(Default)]
struct Replacement {
    groups: Vec<Rewritten>,
    /// The group that was made for a set of tangents, by the hash of the set.
    group_of_hash: HashMap<u64, usize>,
}

impl Replacement {
    /// How many groups are compared with each set of tangents. Further groups are found by equal sets alone,
    /// so that the time is in proportion to the tangents.
    const COMPARED: usize = 4;

    /// Adds primitives to the first group that agrees, or to a new group.
    fn add(&mut self, users: Vec<PrimitiveName>, tangents: &TangentOfVertex) {
        let agrees = |group: &usize| self.groups[*group].agrees_with(tangents);
        let hash = hash_of(tangents);
        let compared = 0..self.groups.len().min(Self::COMPARED);
        match compared.chain(self.group_of_hash.get(&hash).copied()).find(agrees) {
            Some(group) => {
                let group = &mut self.groups[group];
                group.users.extend(users);
                group.of_vertices.extend(tangents);
            }
            None => {
                self.group_of_hash.insert(hash, self.groups.len());
                self.groups.push(Rewritten { users, of_vertices: tangents.clone() });
            }
        }
    }
}

fn hash_of(tangents: &TangentOfVertex) -> u64 {
    let mut hasher = DefaultHasher::new();
    tangents.iter().for_each(|(vertex, tangent)| (vertex, bits(*tangent)).hash(&mut hasher));
    hasher.finish()
}

fn has_targets(document: &Document, names: &[PrimitiveName]) -> bool {
    names.iter().any(|name| !document.meshes()[name.mesh].primitives[name.primitive].targets.is_empty())
}

/// Primitives with the same data, and the correction of their tangents.
type Corrected = (Vec<PrimitiveName>, Correction);

/// Writes corrections that need more vertices.
fn split_vertices(document: &mut Document, corrections: &[Corrected]) -> Result<(), Error> {
    let given = corrections.iter().map(|(primitives, correction)| GivenTangents {
        primitives,
        tangents: &correction.tangent_of_corner,
    });
    document.set_corner_tangents(&given.collect::<Vec<_>>())
}

/// Changes all tangents of primitives.
pub fn change(
    document: &mut Document,
    names: &[PrimitiveName],
    change: fn([f32; 4]) -> [f32; 4],
) -> Result<(), Error> {
    let users = users_of(document, TANGENT, names);
    check_rewritten::<4>(document, users.keys().copied())?;
    for (accessor, users) in users {
        let changed: Vec<[f32; 4]> = document.vectors::<4>(accessor)?.iter().copied().map(change).collect();
        document.set_tangents(&users, &changed)?;
    }
    Ok(())
}

/// Makes the tangents of primitives again. Vertices whose corners need different tangents are split. `kept`:
/// what stays as it is, per primitive.
pub fn make(
    document: &mut Document,
    names: &[PrimitiveName],
    kept: &BTreeMap<Key, Kept>,
    options: &FixOptions,
) -> Result<(), Error> {
    if names.is_empty() {
        return Ok(());
    }
    let mut of_methods: Vec<(TangentOptions, BTreeSet<Key>)> = Vec::new();
    for key in names.iter().map(key) {
        let method = kept.get(&key).and_then(|kept| kept.method);
        let tangents = method.map_or(options.tangents, TangentOptions::from);
        match of_methods.iter_mut().find(|(known, _)| *known == tangents) {
            Some((_, places)) => places.extend([key]),
            None => of_methods.push((tangents, BTreeSet::from([key]))),
        }
    }
    let context = &mut Context::new();
    for (tangents, places) in of_methods {
        let is_wanted = |name: &PrimitiveName| places.contains(&key(name));
        let adding = AddTangentsOptions::default().with_tangents(tangents).with_overwrite(true);
        add_tangents_to(document, &adding, &is_wanted, context, Generate::OnCpu, &mut |_| {})?;
    }
    let staying = |stays: fn(&Kept) -> bool| {
        let names = names.iter().filter(|name| kept.get(&key(name)).is_some_and(stays));
        names.cloned().collect::<Vec<_>>()
    };
    change(document, &staying(|kept| kept.flipped), |[x, y, z, w]| [x, y, z, -w])?;
    change(document, &staying(|kept| kept.negated), |[x, y, z, w]| [-x, -y, -z, w])
}
