#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mjarm {

/// How its user starts the program, such as "./dev": texts that name one of its commands, such as
/// `mjarm run`, name it so from now on. Called once, at the start of a program.
/// @param commands  "mjarm" stays before any other word.
void set_program_name(std::string name, std::vector<std::string> commands);

/// That name; "mjarm" where none was set.
[[nodiscard]] std::string program_name();

/// A text of the catalogue, its values left open, with that name before the commands in it. One
/// that begins with a command is the title of something, and stays.
[[nodiscard]] std::string with_program_name(std::string_view pattern);

}  // namespace mjarm
