#pragma once

#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/units.hpp"
#include "mjarm/core/yaml_tree.hpp"
#include "mjarm/program/program.hpp"

namespace mjarm::program::detail {

/// What is wrong with a program, and where. Thrown within the reader, where every line can fail;
/// never leaves it.
struct ReadFault {
  FilePlace place;
  std::string what;
};

/// What instructions may refer to by name.
struct NamedThings {
  std::map<std::string, ProgramPose> poses;
  std::map<std::string, std::vector<double>> postures;
};

/// A scalar as one of `words`, spelt exactly.
std::string word_of(const YamlNode& node, std::string_view what,
                    const std::vector<std::string>& words);
/// A scalar as text.
std::string text_of(const YamlNode& node, std::string_view what);
/// A scalar as a number with or without a unit, in SI units.
double number_of(const YamlNode& node, std::string_view what, Quantity quantity);
/// The same in a range: (0, most].
double positive_of(const YamlNode& node, std::string_view what, Quantity quantity,
                   double max = 1e6);
/// A list of numbers; `size` 0 takes any but none.
std::vector<double> numbers_of(const YamlNode& node, std::string_view what, Quantity quantity,
                               std::size_t size = 0);
Eigen::Vector3d vector_of(const YamlNode& node, std::string_view what, Quantity quantity);

/// The members of one map. Refuses keys that are not among `keys` when it is made.
class Fields {
 public:
  Fields(const YamlNode& map, std::string_view what, std::initializer_list<const char*> keys);

  [[nodiscard]] const YamlNode* find(std::string_view key) const;
  /// A fault at the map where it is missing.
  [[nodiscard]] const YamlNode& need(std::string_view key) const;
  [[nodiscard]] FilePlace place() const { return map_.place; }
  [[nodiscard]] std::string named(std::string_view key) const;  ///< "movel: speed"

  [[nodiscard]] std::optional<double> positive(std::string_view key, Quantity quantity,
                                               double max = 1e6) const;
  [[nodiscard]] std::optional<double> not_negative(std::string_view key, Quantity quantity) const;
  [[nodiscard]] Eigen::Vector3d vector(std::string_view key, Quantity quantity) const;
  /// From exactly one of `euler`, `quat` and `matrix`.
  [[nodiscard]] Eigen::Matrix3d rotation() const;
  [[nodiscard]] FrameName frame() const;  ///< of `frame`; empty where there is none

 private:
  const YamlNode& map_;
  std::string what_;
};

/// The keys of a pose.
#define MJARM_POSE_KEYS "pos", "euler", "quat", "matrix", "pose", "frame"

/// Pose of a map that was opened with MJARM_POSE_KEYS among its keys: `pos` and a rotation, or the
/// name of a pose.
ProgramPose pose_of(const Fields& fields, const NamedThings& named);
/// A pose by itself: a name, or such a map.
ProgramPose pose_of(const YamlNode& node, std::string_view what, const NamedThings& named);
/// Joint values: a list, or the name of a posture.
std::vector<double> joints_of(const YamlNode& node, std::string_view what,
                              const NamedThings& named);

/// One instruction, `- word: ...`.
Instruction instruction_of(const YamlNode& node, const NamedThings& named);
std::vector<Instruction> instructions_of(const YamlNode& node, std::string_view what,
                                         const NamedThings& named);
/// What `set:` holds, and what stands at the top of a program.
Set set_of(const Fields& fields);

}  // namespace mjarm::program::detail
