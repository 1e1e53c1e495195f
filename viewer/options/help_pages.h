// The help of commands with many options, in pages: what is used most, then each group by its word.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "shell/command_line.h"

namespace CLI {
class Formatter;
}

namespace tenebra::viewer {

/// The columns of all help, and the options that are used most in the order in which people ask for them.
std::shared_ptr<CLI::Formatter> help_format();

/// The page that the word behind --help names, or WORD of `help COMMAND WORD`, which arrives as COMMAND WORD
/// --help; empty: none.
std::string help_topic(std::span<const std::string> arguments);

/// The help of the command that `program` was given; of `program` where it was given none. Where the command
/// has many groups of settings: what is used most, with the topics of the other pages; of a topic the options
/// of its group; "paper": the settings for the papers' experiments; "all": everything. Changes how that
/// command formats its help.
std::string help_page(CLI::App& program, const std::string& topic);

}  // namespace tenebra::viewer
