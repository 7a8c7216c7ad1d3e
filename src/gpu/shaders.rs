//! The shader modules, put together from the pieces in `shaders/` by plain concatenation: layouts, then
//! library functions, then the pass. Names are unique across all pieces.

macro_rules! pieces {
    ($($path:literal),+ $(,)?) => {
        concat!($(include_str!(concat!("../../shaders/", $path)), "\n"),+)
    };
}

/// Casts rays at cells.
pub const CAST: &str = pieces!(
    "layout/view.wgsl",
    "layout/cell.wgsl",
    "layout/face.wgsl",
    "lib/axes.wgsl",
    "lib/place.wgsl",
    "lib/pack.wgsl",
    "lib/ray.wgsl",
    "lib/patch_jet.wgsl",
    "lib/seeds.wgsl",
    "lib/solve.wgsl",
    "lib/classify.wgsl",
    "pass/trims.wgsl",
    "pass/cast.wgsl",
);

/// Draws triangles of the untrimmed surfaces, trimmed per pixel.
pub const MESH: &str = pieces!(
    "layout/view.wgsl",
    "layout/face.wgsl",
    "layout/mesh.wgsl",
    "lib/axes.wgsl",
    "lib/place.wgsl",
    "lib/pack.wgsl",
    "lib/classify.wgsl",
    "pass/trims.wgsl",
    "pass/mesh.wgsl",
);

/// Fills holes between faces by strips along trim curves.
pub const CONCEAL: &str = pieces!(
    "layout/view.wgsl",
    "layout/face.wgsl",
    "layout/ribbon.wgsl",
    "lib/axes.wgsl",
    "lib/pack.wgsl",
    "lib/ray.wgsl",
    "lib/patch_jet.wgsl",
    "lib/ribbon.wgsl",
    "lib/holes.wgsl",
    "pass/conceal.wgsl",
);

/// Draws the triangles of a tessellation.
pub const TESSELLATION: &str = pieces!(
    "layout/view.wgsl",
    "layout/face.wgsl",
    "layout/mesh.wgsl",
    "layout/tessellation.wgsl",
    "lib/axes.wgsl",
    "lib/place.wgsl",
    "lib/pack.wgsl",
    "pass/tessellation.wgsl",
);

/// Shades the visibility buffer.
pub const RESOLVE: &str = pieces!(
    "layout/face.wgsl",
    "layout/look.wgsl",
    "lib/pack.wgsl",
    "lib/ray.wgsl",
    "lib/shade.wgsl",
    "pass/resolve.wgsl",
);

/// Puts the accumulated samples over the background.
pub const PRESENT: &str = pieces!("layout/look.wgsl", "lib/shade.wgsl", "pass/present.wgsl");

/// Puts two kept pictures together.
pub const WIPE: &str = pieces!("pass/wipe.wgsl");

/// Every module with its name, for validation.
pub const MODULES: [(&str, &str); 7] = [
    ("cast", CAST),
    ("mesh", MESH),
    ("tessellation", TESSELLATION),
    ("conceal", CONCEAL),
    ("resolve", RESOLVE),
    ("present", PRESENT),
    ("wipe", WIPE),
];
