#pragma once

#include <span>
#include <string>

#include "mjarm/core/joint_vec.hpp"

/// Members of the JSON object of an answer, each appended with the comma before it.
namespace mjarm::app {

/// The key alone; its value is appended next.
void append_key(std::string& out, const char* key);
void append_value(std::string& out, const char* key, double value);
/// A list of numbers.
void append_value(std::string& out, const char* key, const JointVec& values);
/// A list of lists.
void append_rows(std::string& out, const char* key, std::span<const JointVec> rows);
/// How long it took, to a tenth of a microsecond.
void append_us(std::string& out, double us, const char* key = "us");

}  // namespace mjarm::app
