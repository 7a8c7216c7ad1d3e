//! Every shader module is valid, and every struct lies in memory as its Rust mirror does.

use std::mem::offset_of;

use hairline::encoding::cell::Cell;
use hairline::encoding::{
    FaceHeader, Look, MeshOrigin, MeshVertex, RibbonPiece, RibbonSpan, TessellationPart, View,
};
use hairline::gpu::shaders;
use hairline::kernel::trim::grid::GridHeader;
use naga::valid::{Capabilities, ValidationFlags, Validator};

fn parse(source: &str) -> naga::Module {
    let module =
        naga::front::wgsl::parse_str(source).unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)));
    Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)));
    module
}

#[test]
fn every_module_is_valid() {
    for (name, source) in shaders::MODULES {
        let module = parse(source);
        assert!(module.entry_points.len() >= 2, "{name}");
    }
}

/// Name, offset and order of the members of a struct in a shader.
fn members(module: &naga::Module, name: &str) -> (Vec<(String, usize)>, usize) {
    let (_, ty) =
        module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name)).expect("struct in the shader");
    let naga::TypeInner::Struct { members, span } = &ty.inner else { panic!("{name} is no struct") };
    let list = members.iter().map(|m| (m.name.clone().expect("named"), m.offset as usize)).collect();
    (list, *span as usize)
}

macro_rules! layout {
    ($type:ty: $($field:ident),+ $(,)?) => {
        (vec![$((stringify!($field).to_owned(), offset_of!($type, $field))),+], size_of::<$type>())
    };
}

#[test]
fn rust_mirrors_match_the_shaders() {
    let cast = parse(shaders::CAST);
    let resolve = parse(shaders::RESOLVE);
    let cell = layout!(Cell: box_centre, face, box_x, box_y, box_z, origin_high, first_point, origin_low,
        degrees, uv_min, uv_max, m00, residual, m10, size, m01, flags, m20, pad1, m11, pad2, m02, pad3);
    assert_eq!(members(&cast, "Cell"), cell);
    let view = layout!(View: right, up, forward, reference_high, reference_low, clip_scale, slope_scale,
        offset_scale, jitter, depth, size, pixel, flags, cell_count, pad0, pad1);
    assert_eq!(members(&cast, "View"), view);
    let grid = layout!(GridHeader: columns, rows, scale_u, scale_v, cell_base, entry_base, data_base, flags);
    assert_eq!(members(&cast, "GridHeader"), grid);
    let look = layout!(Look: background_top, background_bottom, edge, selected, hovered, slope_scale,
        offset_scale, jitter, size, depth, mode, edges, samples, edge_width, pixel, difference, pad1);
    assert_eq!(members(&resolve, "Look"), look);
    let conceal = parse(shaders::CONCEAL);
    let piece = layout!(RibbonPiece: origin_high, first_point, origin_low, degrees, uv_min, uv_max, first_curve,
        face, other, gap);
    assert_eq!(members(&conceal, "RibbonPiece"), piece);
    assert_eq!(members(&conceal, "RibbonSpan"), layout!(RibbonSpan: piece, start, end, pad0));
    let mesh = parse(shaders::MESH);
    let vertex = layout!(MeshVertex: position, face, normal, flags, uv, entry, origin);
    assert_eq!(members(&mesh, "MeshVertex"), vertex);
    assert_eq!(members(&mesh, "MeshOrigin"), layout!(MeshOrigin: high, pad0, low, pad1));
    let tessellation = parse(shaders::TESSELLATION);
    assert_eq!(
        members(&tessellation, "MeshVertex"),
        layout!(MeshVertex: position, face, normal, flags, uv, entry, origin)
    );
    let part = layout!(TessellationPart: high, slot, low, pad0);
    assert_eq!(members(&tessellation, "TessellationPart"), part);
    for module in [&cast, &mesh, &resolve] {
        let (mut list, span) = members(module, "FaceHeader");
        list.retain(|(name, _)| !name.starts_with("pad"));
        assert_eq!((list, span), layout!(FaceHeader: colour, flags, number, grid));
    }
}

#[test]
fn constants_match() {
    let find = |module: &naga::Module, name: &str| -> u32 {
        let (_, constant) =
            module.constants.iter().find(|(_, c)| c.name.as_deref() == Some(name)).expect("constant");
        match module.global_expressions[constant.init] {
            naga::Expression::Literal(naga::Literal::U32(value)) => value,
            ref other => panic!("{name}: {other:?}"),
        }
    };
    let cast = parse(shaders::CAST);
    assert_eq!(find(&cast, "CAST_TRIM"), hairline::encoding::view::CAST_TRIM);
    assert_eq!(find(&cast, "CAST_HEAT"), hairline::encoding::view::CAST_HEAT);
    let tessellation = parse(shaders::TESSELLATION);
    assert_eq!(find(&tessellation, "CAST_FACETS"), hairline::encoding::view::CAST_FACETS);
    assert_eq!(find(&tessellation, "CAST_DEVIATION"), hairline::encoding::view::CAST_DEVIATION);
    assert_eq!(find(&cast, "CELL_WHOLE"), Cell::WHOLE);
    assert_eq!(find(&cast, "FACE_TRIMMED"), FaceHeader::TRIMMED);
    assert_eq!(find(&parse(shaders::MESH), "MESH_WHOLE"), MeshVertex::WHOLE);
    assert_eq!(find(&parse(shaders::MESH), "MESH_ZERO_KEPT"), MeshVertex::ZERO_KEPT);
    assert_eq!(find(&parse(shaders::CONCEAL), "RIBBON_SEGMENTS"), hairline::encoding::ribbon::SEGMENTS);
    let resolve = parse(shaders::RESOLVE);
    assert_eq!(find(&resolve, "FACE_VISIBLE"), FaceHeader::VISIBLE);
    assert_eq!(find(&resolve, "FACE_SELECTED"), FaceHeader::SELECTED);
    assert_eq!(find(&resolve, "FACE_HOVERED"), FaceHeader::HOVERED);
    assert_eq!(find(&resolve, "FACE_REVERSED"), FaceHeader::REVERSED);
    assert_eq!(find(&resolve, "MODE_SHADED"), Look::SHADED);
}
