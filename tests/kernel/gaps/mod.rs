//! Edges found by pairing, and gaps of which the size is known.

mod exact;
mod known;
mod live;
mod mending;
mod pairs;
mod piles;
