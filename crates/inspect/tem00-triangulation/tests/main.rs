//! Set-ups and budgets, through the face that programs see.

mod any_numbers;
mod setup_files;
