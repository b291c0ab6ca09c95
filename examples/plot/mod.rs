//! Common to the examples: a diagram in a file.

use std::{fs, io, path::PathBuf};

use kuva::prelude::{Layout, Plot};

/// Writes a diagram with labelled axes to `out/<name>.svg` and returns its path.
pub(crate) fn write(
    name: &str,
    title: &str,
    axes: [&str; 2],
    plots: Vec<Plot>,
) -> io::Result<PathBuf> {
    let layout = Layout::auto_from_plots(&plots)
        .with_title(title)
        .with_x_label(axes[0])
        .with_y_label(axes[1]);
    let folder = PathBuf::from("out");
    fs::create_dir_all(&folder)?;
    let path = folder.join(name).with_extension("svg");
    fs::write(&path, kuva::render_to_svg(plots, layout))?;
    Ok(path)
}
