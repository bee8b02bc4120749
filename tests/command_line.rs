//! Tests of the commands from the outside.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

mod command_line {
    mod black_pictures;
    mod bounds;
    mod compared_pictures;
    mod count_command;
    mod files_are_safe;
    mod hostile_scenes;
    mod inspect_command;
    mod kills;
    mod one_oracle_one_number;
    mod other_renderers;
    mod parts_of_other_work;
    mod parts_of_pictures;
    mod pictures_by_circuits;
    mod playground_command;
    mod render_command;
    mod scenes_from_strangers;
    mod search_command;
    mod shells_and_streams;
    mod simulate_command;
    mod small_commands;
    mod trade_command;
    mod watching;
}
