#pragma once

#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/units.hpp"
#include "mjarm/core/yaml_tree.hpp"
#include "mjarm/program/program_reader.hpp"

namespace mjarm::program::detail {

/// Thrown within the reader, where every value can fail; never leaves it. What reads a whole notes
/// it and goes on, so that one run finds all that is wrong.
using ReadFault = TextFault;
using ReadFaults = std::vector<TextFault>;

/// What instructions may refer to by name, and what was found wrong so far.
struct NamedThings {
  std::map<std::string, ProgramPose> poses = {};
  std::map<std::string, JointValues> postures = {};
  ReadFaults& faults;
};

/// Ends the reading: more faults than anybody mends in one go.
struct TooManyFaults {};

/// Notes a fault, unless it has nothing to say that was not said already.
void note(ReadFaults& faults, const ReadFault& fault);

/// What `read` gives; where it fails, that is noted and `otherwise` comes in its place.
template <class T, class Read>
T or_noted(ReadFaults& faults, T otherwise, const Read& read) {
  try {
    return read();
  } catch (const ReadFault& fault) {
    note(faults, fault);
    return otherwise;
  }
}

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

/// The members of one map. Values that cannot be read are noted and have a value that does no harm;
/// what is missing ends the reading of the map.
class Fields {
 public:
  /// Notes all keys that are not among `keys`.
  Fields(const YamlNode& map, std::string_view what, std::initializer_list<const char*> keys,
         ReadFaults& faults);

  [[nodiscard]] const YamlNode* find(std::string_view key) const;
  /// Ends the reading of the map where it is missing: a fault at the map, unless a misspelt key
  /// explains that already.
  [[nodiscard]] const YamlNode& need(std::string_view key) const;
  /// `read(node, name)` of the member `key`, which must be there.
  template <class T, class Read>
  [[nodiscard]] T take(std::string_view key, T otherwise, const Read& read) const {
    const YamlNode& node = need(key);
    return or_noted(faults_, std::move(otherwise), [&] { return read(node, named(key)); });
  }
  [[nodiscard]] ReadFaults& faults() const { return faults_; }
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
  [[nodiscard]] Eigen::Matrix3d read_rotation() const;
  /// Ends the reading of the map for want of one of `keys`.
  [[noreturn]] void miss(std::initializer_list<std::string_view> keys,
                         const std::string& what) const;

  const YamlNode& map_;
  std::string what_;
  ReadFaults& faults_;
  FilePlace unknown_ = {};          // the first key that nothing knows
  std::vector<std::string> meant_;  // keys that unknown ones were probably meant for
};

/// The keys of a pose.
#define MJARM_POSE_KEYS "pos", "euler", "quat", "matrix", "pose", "frame"

/// Pose of a map that was opened with MJARM_POSE_KEYS among its keys: `pos` and a rotation, or the
/// name of a pose.
ProgramPose pose_of(const Fields& fields, const NamedThings& named);
/// A pose by itself: a name, or such a map.
ProgramPose pose_of(const YamlNode& node, std::string_view what, const NamedThings& named);
/// Joint values: a list, or the name of a posture.
JointValues joints_of(const YamlNode& node, std::string_view what, const NamedThings& named);

/// One instruction, `- word: ...`.
Instruction instruction_of(const YamlNode& node, const NamedThings& named);
/// All that can be read of a list of them; the others are noted.
std::vector<Instruction> instructions_of(const YamlNode& node, std::string_view what,
                                         const NamedThings& named);
/// What `set:` holds, and what stands at the top of a program.
Set set_of(const Fields& fields);

}  // namespace mjarm::program::detail
