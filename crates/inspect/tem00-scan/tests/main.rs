//! Scans of scenes and set-ups, through the face that programs see.

mod rendered_setup;
mod scene_sections;
mod setup_sensor;
