//! Any surface entity: what boundaries are laid on, and how IGES parameters become native ones.

use glam::{DAffine3, DMat3, DVec3};

use super::error::EntityError;
use super::parameter::Args;
use super::store::{Opened, Reader};
use super::{
    analytic190, offset140, plane108, revolution120, ruled118, spline114, surface128, tabulated122,
    transform124,
};
use crate::exchange::boundary::parameter_map::{AxisMap, UvMap};
use crate::kernel::nurbs::NurbsSurface;
use crate::kernel::primitives::{AnalyticSurface, Shape, Sweep};
use crate::kernel::query::Carrier;

/// A surface in model space (millimetres).
#[derive(Debug)]
pub(crate) struct Surface {
    /// Its shape.
    pub carrier: Carrier,
    /// What parameters in the file may mean, likeliest first; none where IGES defines none.
    pub native_from_iges: Vec<UvMap>,
    /// The curve that bounds it by itself (plane, 108), and the transformation of that curve.
    pub boundary: Option<(i64, DAffine3)>,
    /// How a swept surface was made, so that its arcs can be cut to what is used of them.
    pub sweep: Option<Sweep>,
    /// Name, colour and level asked for by the surface itself: its directory entry.
    pub index: usize,
}

/// Reads the surface that `pointer` means, with its transformation and then `outer` applied.
pub(crate) fn read(
    reader: &mut Reader<'_, '_>,
    pointer: i64,
    outer: DAffine3,
) -> Result<Surface, EntityError> {
    reader.open(pointer, "surface", |reader, mut opened| read_opened(reader, &mut opened, outer))
}

/// As [`read`], for an entity already open.
pub(crate) fn read_opened(
    reader: &mut Reader<'_, '_>,
    opened: &mut Opened<'_>,
    outer: DAffine3,
) -> Result<Surface, EntityError> {
    let scale = reader.millimetres();
    let own = outer * transform124::transform(reader, opened.entry.transform, scale)?;
    let index = opened.index;
    let args: &mut Args = &mut opened.args;
    let spline = |surface: NurbsSurface, map: UvMap| Surface {
        carrier: Carrier::spline(placed(surface, own)),
        native_from_iges: vec![map],
        boundary: None,
        sweep: None,
        index,
    };
    Ok(match opened.entry.kind {
        128 => spline(surface128::read(args, scale)?, UvMap::IDENTITY),
        114 => spline(spline114::read(args, scale)?, UvMap::IDENTITY),
        118 => ruled118::read(reader, args).map(|(s, m)| spline(s, m))?,
        120 => revolution120::read(reader, args).map(|(s, m)| swept((s, vec![m]), own, index))??,
        122 => swept(tabulated122::read(reader, args)?, own, index)?,
        108 => {
            let (plane, boundary) = plane108::read(args, scale)?;
            let boundary = boundary.filter(|_| opened.entry.form >= 0).map(|b| (b, own));
            Surface { boundary, ..analytic(moved(plane, own), scale, index) }
        }
        kind @ (190 | 192 | 194 | 196 | 198) => {
            analytic(moved(analytic190::read(reader, kind, args)?, own), scale, index)
        }
        140 => offset140::read(reader, args, own, index)?,
        kind => {
            return Err(EntityError::Kind {
                expected: "a surface",
                kind,
                target: super::store::Store::number(index),
            });
        }
    })
}

fn swept((sweep, maps): (Sweep, Vec<UvMap>), own: DAffine3, index: usize) -> Result<Surface, EntityError> {
    let sweep = Sweep { model_from_local: own, ..sweep };
    let carrier = Carrier::spline(sweep.spline()?);
    // Angles along an arc may be meant a turn away from where the arc starts.
    let turned = |map: UvMap, turns: f64| UvMap { v: map.v.turned(turns), ..map };
    let turned_u = |map: UvMap, turns: f64| UvMap { u: map.u.turned(turns), ..map };
    let mut native_from_iges = maps.clone();
    for map in maps {
        if map.v.arc.is_some() {
            native_from_iges.extend([turned(map, 1.0), turned(map, -1.0)]);
        }
        if map.u.arc.is_some() {
            native_from_iges.extend([turned_u(map, 1.0), turned_u(map, -1.0)]);
        }
    }
    Ok(Surface { carrier, native_from_iges, boundary: None, sweep: Some(sweep), index })
}

fn placed(surface: NurbsSurface, own: DAffine3) -> NurbsSurface {
    if own == DAffine3::IDENTITY { surface } else { surface.map_points(|p: DVec3| own.transform_point3(p)) }
}

fn moved(surface: AnalyticSurface, own: DAffine3) -> AnalyticSurface {
    let place = own * surface.model_from_local;
    // Numbers of a file make frames that are rigid but for rounding; leave those as they are.
    let matrix3 = DMat3::from_cols(place.matrix3.x_axis, place.matrix3.y_axis, place.matrix3.z_axis);
    AnalyticSurface { model_from_local: DAffine3 { matrix3, ..place }, ..surface }
}

/// Angles in files are degrees (IGES 5.3) or radians; lengths are in the file's unit.
pub(crate) fn analytic(surface: AnalyticSurface, scale: f64, index: usize) -> Surface {
    let length = AxisMap::scaling(scale);
    let degrees = AxisMap::scaling(std::f64::consts::PI / 180.0);
    let radians = AxisMap::IDENTITY;
    let native_from_iges = match surface.shape {
        Shape::Plane => vec![UvMap::new(length, length), UvMap::IDENTITY],
        Shape::Cylinder { .. } | Shape::Cone { .. } => {
            vec![UvMap::new(degrees, length), UvMap::new(radians, length)]
        }
        Shape::Sphere { .. } => vec![UvMap::new(degrees, degrees), UvMap::new(radians, radians)],
        Shape::Torus { .. } => {
            // IGES goes round the tube first, and OpenCASCADE writes the other angle backwards.
            let back = AxisMap { scale: -degrees.scale, offset: std::f64::consts::TAU, arc: None };
            vec![
                UvMap { swap: true, u: back, v: degrees },
                UvMap { swap: true, u: degrees, v: degrees },
                UvMap::new(degrees, degrees),
                UvMap::new(radians, radians),
            ]
        }
    };
    Surface { carrier: Carrier::Analytic(surface), native_from_iges, boundary: None, sweep: None, index }
}

/// Whether an entity type is a surface.
pub(crate) fn is_surface(kind: u32) -> bool {
    matches!(kind, 108 | 114 | 118 | 120 | 122 | 128 | 140 | 190 | 192 | 194 | 196 | 198)
}
