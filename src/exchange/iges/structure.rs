//! Which entities become faces, where they stand, and which part they belong to.
//!
//! Faces are trimmed surfaces (144, 143), faces of boundary representations (510) and surfaces that
//! nothing uses. What a subfigure definition (308) or a solid that is instanced (430, 184) holds is
//! placed by its instances only. Groups (402), solids (186), shells (514) and instances (408) become parts.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DAffine3, DVec3};

use super::error::EntityError;
use super::store::{Opened, Reader, Store};
use super::{appearance, surface, transform124};
use crate::exchange::report::{Remark, Severity};
use crate::scene::records::PartRecord;

/// Faces at most, instances counted each time.
const MOST_FACES: usize = 5_000_000;
/// Deepest nesting of instances.
const DEPTH: usize = 32;

/// One face to read.
#[derive(Debug, Clone)]
pub(crate) struct Root {
    /// Position in the directory.
    pub index: usize,
    /// Place in the model.
    pub place: DAffine3,
    /// Position of its part.
    pub part: Option<usize>,
    /// Whether its shell uses it back to front.
    pub reversed: bool,
    /// Planes (108, form -1) whose bounding curves are holes in it.
    pub holes: Vec<usize>,
    /// How often the same entity stands in the model before this one.
    pub instance: u32,
}

/// All faces in file order, and the parts that hold any.
pub(crate) struct Structure {
    pub roots: Vec<Root>,
    pub parts: Vec<PartRecord>,
    pub remarks: Vec<Remark>,
}

/// What an entity holds: pointer, whether it is turned round, its own place.
struct Member {
    index: usize,
    reversed: bool,
    place: DAffine3,
}

/// Entity types with members.
fn is_container(kind: u32) -> bool {
    matches!(kind, 186 | 514 | 402 | 408 | 308 | 430 | 184)
}

fn is_face(kind: u32) -> bool {
    matches!(kind, 144 | 143 | 510)
}

struct Builder<'r, 's, 'a> {
    reader: &'r mut Reader<'s, 'a>,
    members: BTreeMap<usize, (Vec<Member>, Option<String>)>,
    parts: Vec<PartRecord>,
    roots: Vec<Root>,
    path: Vec<usize>,
    full: bool,
}

/// Finds faces and parts.
pub(crate) fn read(store: &Store<'_>) -> Structure {
    let mut reader = Reader::new(store);
    let mut members = BTreeMap::new();
    let mut used = BTreeSet::new();
    let mut defined = BTreeSet::new();
    let mut holes: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (index, entry) in store.entries.iter().enumerate() {
        reader.refresh();
        let pointer = Store::number(index) as i64;
        if is_container(entry.kind) && (entry.kind != 402 || matches!(entry.form, 1 | 7 | 14 | 15)) {
            match reader.open(pointer, "structure", contents) {
                Ok((list, name)) => {
                    let definition = matches!(entry.kind, 308 | 430 | 184 | 408);
                    if definition {
                        defined.extend(list.iter().map(|m| m.index));
                    }
                    members.insert(index, (list, name));
                }
                Err(error) => reader.remark(index, Severity::Error, format!("skipped: {error}")),
            }
        } else if entry.kind == 402 && entry.form == 9 {
            match reader.open(pointer, "structure", perforation) {
                Ok(Some((plane, list))) => {
                    used.extend(&list);
                    holes.entry(plane).or_default().extend(list);
                }
                Ok(None) => {}
                Err(error) => reader.remark(index, Severity::Error, format!("skipped: {error}")),
            }
        } else if is_face(entry.kind) || entry.kind == 140 {
            let surface = reader.open(pointer, "face", |reader, mut opened| {
                opened.args.skip(match opened.entry.kind {
                    143 => 1,
                    140 => 4,
                    _ => 0,
                });
                let pointer = opened.args.required("surface")?;
                reader.store.index(pointer, "surface")
            });
            // A pointer that is bad is reported when the face is read.
            used.extend(surface.ok());
        }
    }
    // Containers that stand in another one are reached from there.
    let inner: BTreeSet<usize> =
        members.values().flat_map(|(list, _)| list.iter().map(|m| m.index)).collect();
    let mut builder = Builder {
        reader: &mut reader,
        members,
        parts: Vec::new(),
        roots: Vec::new(),
        path: Vec::new(),
        full: false,
    };
    let mut seen = BTreeSet::new();
    for (index, entry) in store.entries.iter().enumerate() {
        if !inner.contains(&index) && is_container(entry.kind) && entry.kind != 308 {
            builder.walk(index, DAffine3::IDENTITY, None, false);
        }
    }
    seen.extend(builder.roots.iter().map(|r| r.index));
    // Rings of groups have no outermost one: their faces are not lost.
    for (index, entry) in store.entries.iter().enumerate() {
        let face = is_face(entry.kind) || (surface::is_surface(entry.kind) && !used.contains(&index));
        if face && !seen.contains(&index) && !defined.contains(&index) {
            builder.roots.push(Root {
                index,
                place: DAffine3::IDENTITY,
                part: None,
                reversed: false,
                holes: Vec::new(),
                instance: 0,
            });
        }
    }
    let Builder { mut parts, mut roots, full, .. } = builder;
    if full {
        reader.remarks.push(Remark {
            severity: Severity::Error,
            entity: String::new(),
            id: 0,
            line: 0,
            message: format!("more than {MOST_FACES} faces; the rest is left out"),
        });
    }
    roots.retain(|r| is_face(store.entries[r.index].kind) || !used.contains(&r.index));
    roots.sort_by_key(|r| r.index);
    for root in &mut roots {
        root.holes = holes.get(&root.index).cloned().unwrap_or_default();
    }
    for k in 1..roots.len() {
        if roots[k].index == roots[k - 1].index {
            roots[k].instance = roots[k - 1].instance + 1;
        }
    }
    drop_empty(&mut parts, &mut roots);
    Structure { roots, parts, remarks: reader.remarks }
}

impl Builder<'_, '_, '_> {
    fn walk(&mut self, index: usize, place: DAffine3, part: Option<usize>, reversed: bool) {
        let kind = self.reader.store.entries[index].kind;
        if self.roots.len() >= MOST_FACES || self.path.len() > DEPTH {
            self.full |= self.roots.len() >= MOST_FACES;
            return;
        }
        if is_face(kind) || surface::is_surface(kind) {
            self.roots.push(Root { index, place, part, reversed, holes: Vec::new(), instance: 0 });
            return;
        }
        if !is_container(kind) || self.path.contains(&index) {
            return;
        }
        let Some((list, name)) = self.members.remove(&index) else { return };
        // A definition is not a part of its own: its instance is. Nor is the only shell of a solid.
        let alone = kind == 514 && part.is_some();
        let own = if kind == 308 || alone {
            if let (308, Some(p), Some(n)) = (kind, part, &name) {
                self.parts[p].name.clone_from(n);
            }
            part
        } else {
            let name = name.clone().unwrap_or_else(|| format!("{} {}", noun(kind), Store::number(index)));
            self.parts.push(PartRecord { name, parent: part });
            Some(self.parts.len() - 1)
        };
        self.path.push(index);
        for member in &list {
            self.walk(member.index, place * member.place, own, reversed != member.reversed);
        }
        self.path.pop();
        self.members.insert(index, (list, name));
    }
}

fn noun(kind: u32) -> &'static str {
    match kind {
        186 => "Solid",
        514 => "Shell",
        408 | 430 => "Instance",
        184 => "Assembly",
        _ => "Group",
    }
}

/// Members and name of a container.
fn contents(
    reader: &mut Reader<'_, '_>,
    mut opened: Opened<'_>,
) -> Result<(Vec<Member>, Option<String>), EntityError> {
    let scale = reader.millimetres();
    let mut place = transform124::transform(reader, opened.entry.transform, scale)?;
    let label = Some(opened.entry.label.clone()).filter(|l| !l.is_empty());
    let mut name = None;
    let args = &mut opened.args;
    // Pointers, each with a flag (1: as it is) or, for assemblies, a transformation.
    let mut list: Vec<(Option<i64>, bool, i64)> = Vec::new();
    match opened.entry.kind {
        402 => {
            for _ in 0..args.count("number of members", 1)? {
                list.push((args.pointer("member")?, false, 0));
            }
        }
        308 => {
            args.skip(1); // depth
            name = Some(args.text()).filter(|n| !n.is_empty());
            for _ in 0..args.count("number of members", 1)? {
                list.push((args.pointer("member")?, false, 0));
            }
        }
        408 => {
            let definition = args.pointer("definition")?;
            let shift = args.point("translation", scale)?;
            let factor = args.real_or("scale", 1.0)?;
            let factor = if factor == 0.0 { 1.0 } else { factor };
            place = DAffine3::from_translation(shift) * place * DAffine3::from_scale(DVec3::splat(factor));
            list.push((definition, false, 0));
        }
        430 => list.push((args.pointer("solid")?, false, 0)),
        184 => {
            let count = args.count("number of items", 2)?;
            for _ in 0..count {
                list.push((args.pointer("item")?, false, 0));
            }
            for item in &mut list {
                item.2 = args.pointer("transformation")?.unwrap_or(0);
            }
        }
        514 => {
            for _ in 0..args.count("number of faces", 2)? {
                let pointer = args.pointer("face")?;
                list.push((pointer, args.integer_or("orientation", 1)? == 0, 0));
            }
        }
        _ => {
            let shell = args.pointer("shell")?;
            list.push((shell, args.integer_or("orientation", 1)? == 0, 0));
            for _ in 0..args.count("number of voids", 2)? {
                let pointer = args.pointer("void shell")?;
                list.push((pointer, args.integer_or("orientation", 1)? == 0, 0));
            }
        }
    }
    let mut members = Vec::with_capacity(list.len());
    for (pointer, reversed, matrix) in list {
        let Some(pointer) = pointer else { continue };
        let Ok(index) = reader.store.index(pointer, "member") else {
            let message = format!("member {pointer} does not exist");
            reader.remark(opened.index, Severity::Warning, message);
            continue;
        };
        let own = transform124::transform(reader, matrix, scale)?;
        members.push(Member { index, reversed, place: place * own });
    }
    let property = appearance::name_property(reader, &mut opened.args);
    Ok((members, property.or(name).or(label)))
}

/// A plane and the planes that are holes in it (single parent associativity, 402 form 9); `None` when it
/// is about something else.
fn perforation(
    reader: &mut Reader<'_, '_>,
    mut opened: Opened<'_>,
) -> Result<Option<(usize, Vec<usize>)>, EntityError> {
    let args = &mut opened.args;
    args.skip(1); // number of parents: one
    let count = args.count("number of children", 1)?;
    let plane = reader.store.index(args.required("parent")?, "parent")?;
    let mut holes = Vec::with_capacity(count);
    for _ in 0..count {
        holes.push(reader.store.index(args.required("child")?, "child")?);
    }
    let planes = holes.iter().chain([&plane]).all(|i| reader.store.entries[*i].kind == 108);
    Ok(planes.then_some((plane, holes)))
}

/// Leaves out parts without faces.
fn drop_empty(parts: &mut Vec<PartRecord>, roots: &mut [Root]) {
    let mut keep = vec![false; parts.len()];
    for root in roots.iter() {
        let mut at = root.part;
        while let Some(part) = at {
            if keep[part] {
                break;
            }
            keep[part] = true;
            at = parts[part].parent;
        }
    }
    let mut place = vec![None; parts.len()];
    let mut kept = Vec::new();
    for (old, part) in std::mem::take(parts).into_iter().enumerate() {
        if keep[old] {
            // Parents come before children, so their place is known.
            let parent = part.parent.and_then(|p| place[p]);
            place[old] = Some(kept.len());
            kept.push(PartRecord { parent, ..part });
        }
    }
    for root in roots {
        root.part = root.part.and_then(|p| place[p]);
    }
    *parts = kept;
}
