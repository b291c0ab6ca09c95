//! The options of the commands that render a scene.

use std::path::PathBuf;

use clap::Args;
use tem00_report::args::{FileArgs, IndexRange};
use tem00_tracer::{RenderOptions, Sampling};

/// A scene, and what is rendered of it.
#[derive(Args, Debug)]
pub struct SceneArgs {
    /// The scene file, or - for standard input.
    #[arg(value_name = "SCENE.toml")]
    pub scene: PathBuf,

    /// How the scene file is read.
    #[command(flatten)]
    pub files: FileArgs,

    /// The folder for the files, made if it is missing [default: out/<name of the scene>].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// Camera samples per pixel, 1 to a million [default: from the scene].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    spp: Option<u32>,

    /// Fewer samples where they agree, more at edges and in narrow beams: --spp on average at most
    /// [default: from the scene].
    #[arg(long)]
    adaptive: bool,

    /// The seed of everything random [default: from the scene].
    #[arg(long, value_name = "N")]
    seed: Option<u64>,

    /// Only these frames, counted from 0: one, or FIRST..LAST with both ends; a frame is the same however
    /// frames are distributed [default: all].
    #[arg(long, visible_alias = "frame", value_name = "N|FIRST..LAST")]
    pub frames: Option<IndexRange>,

    /// Threads to work with, 1 to 1024, four for each core at most; the result does not depend on it [default: all].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,

    /// Leave the speckle out.
    #[arg(long)]
    pub no_speckle: bool,
}

impl SceneArgs {
    /// Replaces the options of a scene by those of the command line.
    pub fn overrule(&self, options: &mut RenderOptions) {
        options.samples_per_pixel = self.spp.unwrap_or(options.samples_per_pixel);
        options.seed = self.seed.unwrap_or(options.seed);
        if self.adaptive {
            options.sampling = Sampling::Adaptive;
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;
    use crate::args::{Cli, Command};

    fn parse(line: &str) -> Result<SceneArgs, clap::Error> {
        let cli = Cli::try_parse_from(line.split_whitespace())?;
        match cli.command {
            Command::Render(args) => Ok(args.common),
            other => panic!("{other:?} renders no scene"),
        }
    }

    #[test]
    fn scenes_are_rendered_with_the_same_options() {
        for command in ["render", "triangulate"] {
            let line = format!(
                "tem00 {command} a.toml -o d --spp 3 --adaptive --seed 4 --threads 2 --no-speckle \
                 --frames 2..7"
            );
            let args = parse(&line).expect("the line is valid");
            assert_eq!(args.scene, PathBuf::from("a.toml"));
            assert_eq!(args.output, Some(PathBuf::from("d")));
            assert_eq!((args.spp, args.seed), (Some(3), Some(4)));
            assert!(args.adaptive, "it is on");
            assert_eq!(args.threads, Some(2));
            assert!(args.no_speckle, "it is on");
            assert_eq!(args.frames, Some(IndexRange { first: 2, last: 7 }));

            let args = parse(&format!("tem00 {command} a.toml")).expect("the line is valid");
            assert!(args.output.is_none() && args.frames.is_none(), "{args:?}");
            assert!(args.spp.is_none() && args.seed.is_none(), "{args:?}");
            assert!(!args.no_speckle && !args.adaptive, "{args:?}");
            assert!(parse(&format!("tem00 {command}")).is_err(), "no scene");
        }
    }

    #[test]
    fn frames_are_one_or_a_range() {
        let range = |text: &str| text.parse::<IndexRange>();
        assert_eq!(range("4"), Ok(IndexRange { first: 4, last: 4 }));
        assert_eq!(range("0..9"), Ok(IndexRange { first: 0, last: 9 }));
        for bad in [
            "",
            "..",
            "3..",
            "..3",
            "5..3",
            "-1",
            "1.5",
            "1..2..3",
            "99999999999",
        ] {
            assert!(range(bad).is_err(), "{bad} is no range");
        }
        let one = parse("tem00 render a.toml --frame 4").expect("the line is valid");
        assert_eq!(one.frames, Some(IndexRange { first: 4, last: 4 }));
    }
}
