//! The worked examples of the guides.

mod examples_of_jcgm_100;
mod examples_of_jcgm_101;
