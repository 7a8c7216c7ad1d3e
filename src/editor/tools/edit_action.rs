//! The commands that edit what is selected, and the values they ask for.

/// An editing command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the table says it in words")]
pub enum EditAction {
    Cut,
    Copy,
    Paste,
    Duplicate,
    Delete,
    AddRectangle,
    AddCircle,
    AddEllipse,
    AddPolyline,
    AddText,
    MoveBy,
    Rotate,
    Scale,
    MirrorU,
    MirrorV,
    ReverseLoop,
    CloseLoop,
    MakeHole,
    MakeOuter,
    Untrim,
    SetPoint,
    SetWeight,
    InsertKnot,
    RemoveKnot,
    Elevate,
    Reduce,
    Split,
    Join,
    InsertKnotU,
    InsertKnotV,
    ElevateU,
    ElevateV,
    ReverseU,
    ReverseV,
    SwapUv,
    FlipNormal,
    MoveSurfacePoints,
    Rename,
    Colour,
    Layer,
}

/// What an editing command needs to be selected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Needs {
    /// Faces, or elements of one.
    Anything,
    /// One face whose trims are edited.
    Face,
    /// At least one face.
    Faces,
    /// At least one loop, or anything of one.
    Loops,
    /// Exactly one curve.
    Curve,
    /// Control points of trim curves, curves or loops.
    Points,
    /// Exactly one control point of a trim curve.
    Point,
    /// Control points of trim curves or of the surface.
    Weights,
    /// Control points of the surface.
    SurfacePoints,
    /// Loops that were copied, and a face to put them.
    Clipboard,
}

impl EditAction {
    /// What must be selected.
    pub const fn needs(self) -> Needs {
        match self {
            Self::Delete | Self::Duplicate => Needs::Anything,
            Self::Paste => Needs::Clipboard,
            Self::Cut
            | Self::Copy
            | Self::Rotate
            | Self::Scale
            | Self::MirrorU
            | Self::MirrorV
            | Self::ReverseLoop
            | Self::CloseLoop
            | Self::MakeHole
            | Self::MakeOuter => Needs::Loops,
            Self::MoveBy => Needs::Points,
            Self::SetPoint => Needs::Point,
            Self::SetWeight => Needs::Weights,
            Self::InsertKnot | Self::RemoveKnot | Self::Elevate | Self::Reduce | Self::Split | Self::Join => {
                Needs::Curve
            }
            Self::MoveSurfacePoints => Needs::SurfacePoints,
            Self::Rename | Self::Colour | Self::Layer | Self::FlipNormal => Needs::Faces,
            Self::AddRectangle
            | Self::AddCircle
            | Self::AddEllipse
            | Self::AddPolyline
            | Self::AddText
            | Self::Untrim
            | Self::InsertKnotU
            | Self::InsertKnotV
            | Self::ElevateU
            | Self::ElevateV
            | Self::ReverseU
            | Self::ReverseV
            | Self::SwapUv => Needs::Face,
        }
    }

    /// Names of the values that it asks for; none: it is done at once.
    pub const fn fields(self) -> &'static [&'static str] {
        match self {
            Self::AddRectangle => &["First corner u", "First corner v", "Second corner u", "Second corner v"],
            Self::AddCircle => &["Centre u", "Centre v", "Radius"],
            Self::AddEllipse => {
                &["Centre u", "Centre v", "Radius along u", "Radius along v", "Turned by (degrees)"]
            }
            Self::AddPolyline => &["Points: u v, u v, u v, …"],
            Self::AddText => &["Text", "Middle u", "Middle v", "Height of capitals"],
            Self::MoveBy => &["By u", "By v"],
            Self::Rotate => &["Degrees, counter-clockwise"],
            Self::Scale => &["Factor along u", "Factor along v"],
            Self::SetPoint => &["u", "v"],
            Self::SetWeight => &["Weight"],
            Self::InsertKnot | Self::Split => &["At parameter"],
            Self::RemoveKnot => &["Knot", "Tolerance"],
            Self::Reduce => &["Tolerance"],
            Self::InsertKnotU => &["At u"],
            Self::InsertKnotV => &["At v"],
            Self::MoveSurfacePoints => &["By x", "By y", "By z"],
            Self::Rename => &["Name"],
            Self::Colour => &["Colour (#rrggbb; empty: none)"],
            Self::Layer => &["Layer (empty: none)"],
            _ => &[],
        }
    }
}
