#pragma once

#include <string>

namespace CLI {
class App;
}

namespace fleetmap::apps {

/// A man page (section 1, roff) of a program: its options, and those of each command and of the commands in
/// it, with the defaults that they captured; the exit codes.
std::string man_page(const CLI::App& program);

/// Removes captured defaults that state nothing, of empty lists and paths, also from the help of all
/// commands.
void drop_empty_defaults(CLI::App& program);

/// A script for bash that completes the program's commands, its options after a dash, and the values of
/// options that have few; everything else is completed as a file name.
std::string bash_completion(const CLI::App& program);

}  // namespace fleetmap::apps
