//! Sections of scene files and set-up files.
