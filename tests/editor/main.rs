//! Headless and windowed tests of the editor.
