//! Which operations an editing command asks for, by what is selected and the values typed.

use glam::{DVec2, DVec3};

use super::values::Values;
use crate::editor::elements::{Element, ElementSelection};
use crate::editor::tools::EditAction;
use crate::editor::uv::view::natural_stretch;
use crate::kernel::nurbs::Direction;
use crate::kernel::primitives::lettering;
use crate::kernel::trim::UvRect;
use crate::scene::FaceId;
use crate::scene::operation::{CurveId, NetId, Operation, PointId, Shape, Transform};
use crate::scene::records::{FaceRecord, LoopRecord, LoopRole};

/// What an editing command is about.
#[derive(Debug, Clone, Copy)]
pub struct Target<'a> {
    /// The face whose trims are edited, and its record.
    pub face: Option<(FaceId, &'a FaceRecord)>,
    /// What of it is selected.
    pub elements: &'a ElementSelection,
    /// All selected faces.
    pub faces: &'a [FaceId],
    /// Loops that were copied.
    pub clipboard: &'a [LoopRecord],
}

/// A step: its name and what it does. No name: the one of the only operation.
pub type Step = (String, Vec<Operation>);

/// Curves meant by a selection: those selected, those of selected loops and of selected points.
pub fn curves_meant(elements: &ElementSelection, loops: &[LoopRecord]) -> Vec<(usize, usize)> {
    let mut curves = elements.curves(loops);
    curves.extend(elements.elements().filter_map(|e| e.curve()));
    curves.sort_unstable();
    curves.dedup();
    curves
}

/// The step that does `action` to `target`.
///
/// # Errors
/// A value makes no sense, or nothing fitting is selected; in words for the user.
pub fn operations(action: EditAction, target: &Target, values: &[String]) -> Result<Step, String> {
    use EditAction as A;
    let values = Values::new(action.fields(), values);
    match action {
        A::Delete => return delete(target),
        A::Rename | A::Colour | A::Layer | A::FlipNormal => return faces(action, target, &values),
        A::Duplicate if target.elements.loops().is_empty() => {
            let faces = some(target.faces.to_vec(), "face")?;
            return one(Operation::DuplicateFaces { faces, by: DVec3::ZERO });
        }
        _ => {}
    }
    let (face, record) = target.face.ok_or("Select a face first")?;
    let loops = || some(target.elements.loops(), "loop");
    match action {
        A::AddRectangle | A::AddCircle | A::AddEllipse | A::AddPolyline | A::AddText => {
            let role = if record.loops.is_empty() && action != A::AddText {
                LoopRole::Outer
            } else {
                LoopRole::Unknown
            };
            one(Operation::AddLoop { face, shape: shape(action, record, &values)?, role })
        }
        A::Cut => one(Operation::DeleteLoops { face, loops: loops()? }),
        A::Paste => {
            let loops = some(target.clipboard.to_vec(), "copied loop")?;
            one(Operation::PasteLoops { face, loops, by: DVec2::ZERO })
        }
        A::Duplicate => one(Operation::DuplicateLoops { face, loops: loops()?, by: DVec2::ZERO }),
        A::Rotate => {
            let transform = Transform::Rotate { degrees: values.number(0)?, about: None };
            one(Operation::TransformLoops { face, loops: loops()?, transform, beyond: false })
        }
        A::Scale => {
            let transform = Transform::Scale { by: values.uv(0)?, about: None };
            one(Operation::TransformLoops { face, loops: loops()?, transform, beyond: false })
        }
        A::MirrorU | A::MirrorV => {
            let along = if action == A::MirrorU { DVec2::Y } else { DVec2::X };
            let transform = Transform::Mirror { along, about: None };
            one(Operation::TransformLoops { face, loops: loops()?, transform, beyond: false })
        }
        A::ReverseLoop => one(Operation::ReverseLoops { face, loops: loops()? }),
        A::CloseLoop => one(Operation::CloseLoops { face, loops: loops()? }),
        A::MakeHole => one(Operation::SetRole { face, loops: loops()?, role: LoopRole::Inner }),
        A::MakeOuter => one(Operation::SetRole { face, loops: loops()?, role: LoopRole::Outer }),
        A::Untrim => one(Operation::Untrim { face }),
        A::MoveBy | A::SetPoint | A::SetWeight => points(action, face, record, target.elements, &values),
        A::InsertKnot | A::RemoveKnot | A::Elevate | A::Reduce | A::Split | A::Join => {
            curve(action, face, record, target.elements, &values)
        }
        _ => surface(action, face, record, target.elements, &values),
    }
}

fn one(operation: Operation) -> Result<Step, String> {
    Ok((String::new(), vec![operation]))
}

fn some<T>(list: Vec<T>, what: &str) -> Result<Vec<T>, String> {
    if list.is_empty() { Err(format!("Select a {what} first")) } else { Ok(list) }
}

/// Loops and curves of the face in hand, else whole faces.
fn delete(target: &Target) -> Result<Step, String> {
    let Some((face, _)) = target.face.filter(|_| !target.elements.is_empty()) else {
        return one(Operation::DeleteFaces { faces: some(target.faces.to_vec(), "face")? });
    };
    let mut loops = Vec::new();
    let mut curves = Vec::new();
    for element in target.elements.elements() {
        match element {
            Element::Loop { trim_loop } => loops.push(trim_loop),
            Element::Curve { trim_loop, curve } => curves.push(CurveId { trim_loop, curve }),
            _ => {}
        }
    }
    curves.retain(|c| !loops.contains(&c.trim_loop));
    // The loops go first; those behind them move up.
    curves.iter_mut().for_each(|c| c.trim_loop -= loops.iter().filter(|l| **l < c.trim_loop).count());
    let mut operations = Vec::new();
    if !loops.is_empty() {
        operations.push(Operation::DeleteLoops { face, loops });
    }
    if !curves.is_empty() {
        operations.push(Operation::DeleteCurves { face, curves });
    }
    if operations.is_empty() {
        return Err("Control points go with their curve, or with a knot (Remove knot)".into());
    }
    Ok(("Delete".into(), operations))
}

fn faces(action: EditAction, target: &Target, values: &Values) -> Result<Step, String> {
    let faces = some(target.faces.to_vec(), "face")?;
    match action {
        EditAction::Rename => one(Operation::SetName { faces, name: values.text(0) }),
        EditAction::Colour => one(Operation::SetColour { faces, colour: values.colour(0)? }),
        EditAction::Layer => one(Operation::SetLayer { faces, layer: values.layer(0)? }),
        _ => {
            let flips = faces.iter().map(|face| Operation::FlipNormal { face: *face }).collect();
            Ok((format!("Flip {} normals", faces.len()), flips))
        }
    }
}

fn shape(action: EditAction, record: &FaceRecord, values: &Values) -> Result<Shape, String> {
    Ok(match action {
        EditAction::AddRectangle => Shape::Rectangle { from: values.uv(0)?, to: values.uv(2)? },
        EditAction::AddCircle => Shape::Circle { centre: values.uv(0)?, radius: values.number(2)? },
        EditAction::AddEllipse => {
            Shape::Ellipse { centre: values.uv(0)?, radii: values.uv(2)?, degrees: values.number(4)? }
        }
        EditAction::AddText => text(record, values)?,
        _ => Shape::Polyline { points: values.points(0)? },
    })
}

/// A line of text around a point, with letters as wide on the surface as they are made.
fn text(record: &FaceRecord, values: &Values) -> Result<Shape, String> {
    let (text, middle, height) = (values.required(0)?, values.uv(1)?, values.number(3)?);
    let stretch = natural_stretch(&record.surface, &UvRect::of_surface(&record.surface));
    // Letters that there are none of are refused, by name, when the step is worked out.
    let own_width = lettering::text(&text).map_or(0.0, |(_, width)| width);
    let width = own_width * (height / lettering::HEIGHT) / stretch;
    let at = middle - 0.5 * DVec2::new(width, height);
    Ok(Shape::Text { text, at, height, width: (width > 0.0).then_some(width) })
}

fn points(
    action: EditAction,
    face: FaceId,
    record: &FaceRecord,
    elements: &ElementSelection,
    values: &Values,
) -> Result<Step, String> {
    let points = elements.points(&record.loops);
    let points: Vec<PointId> =
        points.into_iter().map(|(trim_loop, curve, point)| PointId { trim_loop, curve, point }).collect();
    match action {
        EditAction::MoveBy => {
            let points = some(points, "point, curve or loop")?;
            one(Operation::MovePoints { face, points, by: values.uv(0)?, beyond: false })
        }
        EditAction::SetPoint => match points.as_slice() {
            [point] => one(Operation::SetPoint { face, point: *point, to: values.uv(0)?, beyond: false }),
            _ => Err("Select one control point first".into()),
        },
        _ => {
            let weight = values.number(0)?;
            let net = net(record, elements);
            let mut operations = Vec::new();
            if !points.is_empty() {
                operations.push(Operation::SetWeight { face, points, weight });
            }
            if !net.is_empty() {
                operations.push(Operation::SetSurfaceWeight { face, points: net, weight });
            }
            Ok(("Set weight".into(), some(operations, "control point")?))
        }
    }
}

fn net(record: &FaceRecord, elements: &ElementSelection) -> Vec<NetId> {
    let (_, count_v) = record.surface.counts();
    elements.surface_points().into_iter().map(|k| NetId { i: k / count_v, j: k % count_v }).collect()
}

fn curve(
    action: EditAction,
    face: FaceId,
    record: &FaceRecord,
    elements: &ElementSelection,
    values: &Values,
) -> Result<Step, String> {
    let curve = match curves_meant(elements, &record.loops).as_slice() {
        [(trim_loop, curve)] => CurveId { trim_loop: *trim_loop, curve: *curve },
        _ => return Err("Select one curve first".into()),
    };
    one(match action {
        EditAction::InsertKnot => Operation::InsertKnot { face, curve, at: values.number(0)?, times: 1 },
        EditAction::RemoveKnot => {
            let (at, tolerance) = (values.number(0)?, values.optional(1)?);
            Operation::RemoveKnot { face, curve, at, tolerance }
        }
        EditAction::Elevate => Operation::ElevateDegree { face, curve, by: 1 },
        EditAction::Reduce => Operation::ReduceDegree { face, curve, tolerance: values.optional(0)? },
        EditAction::Split => Operation::SplitCurve { face, curve, at: values.number(0)? },
        _ => Operation::JoinCurves { face, curve, tolerance: None },
    })
}

fn surface(
    action: EditAction,
    face: FaceId,
    record: &FaceRecord,
    elements: &ElementSelection,
    values: &Values,
) -> Result<Step, String> {
    use EditAction as A;
    let direction = match action {
        A::InsertKnotV | A::ElevateV | A::ReverseV => Direction::V,
        _ => Direction::U,
    };
    one(match action {
        A::InsertKnotU | A::InsertKnotV => {
            Operation::InsertSurfaceKnot { face, direction, at: values.number(0)?, times: 1 }
        }
        A::ElevateU | A::ElevateV => Operation::ElevateSurface { face, direction, by: 1 },
        A::ReverseU | A::ReverseV => Operation::ReverseSurface { face, direction },
        A::SwapUv => Operation::SwapSurface { face },
        A::MoveSurfacePoints => {
            let points = some(net(record, elements), "surface control point")?;
            Operation::MoveSurfacePoints { face, points, by: values.xyz(0)? }
        }
        other => return Err(format!("{other:?} is not a command of surfaces")),
    })
}
