#include <algorithm>
#include <cmath>
#include <utility>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/program.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/program/fields_internal.hpp"

namespace mjarm::program::detail {
namespace {

template <class Map>
std::vector<std::string> names_of(const Map& map) {
  std::vector<std::string> names;
  for (const auto& [name, thing] : map) names.push_back(name);
  return names;
}

/// The thing of that name; a fault with the nearest name where there is none.
template <class Thing>
const Thing& look_up(const std::map<std::string, Thing>& things, const YamlNode& node,
                     std::string_view what, Msg unknown) {
  const std::string name = text_of(node, what);
  const auto found = things.find(name);
  if (found == things.end()) {
    throw ReadFault{node.place, text(unknown, what, name) + did_you_mean(name, names_of(things))};
  }
  return found->second;
}

Eigen::Matrix3d matrix_of(const YamlNode& node, const std::string& what) {
  std::vector<double> entries;
  if (node.kind == YamlNode::Kind::list && node.items.size() == 3) {
    for (const YamlNode& row : node.items) {
      const auto numbers = numbers_of(row, what, Quantity::number, 3);
      entries.insert(entries.end(), numbers.begin(), numbers.end());
    }
  } else {
    entries = numbers_of(node, what, Quantity::number, 9);
  }
  const Eigen::Matrix3d R =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(entries.data());
  constexpr double kRounded = 1e-3;  // a matrix written with four digits
  if (!((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < kRounded) ||
      R.determinant() < 0) {
    throw ReadFault{node.place, text(msg::program_no_rotation, what)};
  }
  return to_matrix(to_quat(R));
}

Eigen::Matrix3d quat_of(const YamlNode& node, const std::string& what) {
  const auto wxyz = numbers_of(node, what, Quantity::number, 4);
  const double norm = Eigen::Map<const Eigen::Vector4d>(wxyz.data()).norm();
  constexpr double kRounded = 1e-3;
  if (!(std::abs(norm - 1) < kRounded)) {
    throw ReadFault{node.place, text(msg::program_no_unit_quat, what, norm)};
  }
  return to_matrix(Quat(wxyz[0], wxyz[1], wxyz[2], wxyz[3]).normalized());
}

Eigen::Matrix3d euler_of(const YamlNode& node, const std::string& what) {
  return from_euler(vector_of(node, what, Quantity::angle));
}

/// A list of `size` entries; 0 takes any number but none.
const std::vector<YamlNode>& list_of(const YamlNode& node, std::string_view what,
                                     std::size_t size) {
  const bool list = node.kind == YamlNode::Kind::list;
  if (list && (size != 0 ? node.items.size() == size : !node.items.empty())) return node.items;
  throw ReadFault{node.place, size == 0 ? text(msg::program_expected_list, what)
                                        : text(msg::program_expected_numbers, what, size,
                                               list ? node.items.size() : std::size_t{0})};
}

}  // namespace

void note(ReadFaults& faults, const ReadFault& fault) {
  constexpr std::size_t kMax = 100;
  if (fault.what.empty()) return;
  faults.push_back(fault);
  if (faults.size() >= kMax) throw TooManyFaults{};
}

std::string text_of(const YamlNode& node, std::string_view what) {
  if (node.kind != YamlNode::Kind::scalar || node.text.empty()) {
    throw ReadFault{node.place, text(msg::program_expected_word, what)};
  }
  return node.text;
}

std::string word_of(const YamlNode& node, std::string_view what,
                    const std::vector<std::string>& words) {
  const std::string word = text_of(node, what);
  if (std::ranges::find(words, word) == words.end()) {
    throw ReadFault{node.place, text(msg::program_expected_one_of, what, listed(words), word) +
                                    did_you_mean(word, words)};
  }
  return word;
}

double number_of(const YamlNode& node, std::string_view what, Quantity quantity) {
  if (node.kind != YamlNode::Kind::scalar || node.quoted) {
    throw ReadFault{node.place, text(msg::program_expected_number, what)};
  }
  const Result<double> value = parse_quantity(node.text, quantity);
  if (!value) throw ReadFault{node.place, text(msg::program_in, what, value.error().what)};
  return *value;
}

double positive_of(const YamlNode& node, std::string_view what, Quantity quantity, double max) {
  const double value = number_of(node, what, quantity);
  if (!(value > 0) || value > max) {
    throw ReadFault{node.place, text(msg::program_out_of_range, what, max, value)};
  }
  return value;
}

std::vector<double> numbers_of(const YamlNode& node, std::string_view what, Quantity quantity,
                               std::size_t size) {
  std::vector<double> numbers;
  for (const YamlNode& item : list_of(node, what, size)) {
    numbers.push_back(number_of(item, what, quantity));
  }
  return numbers;
}

Eigen::Vector3d vector_of(const YamlNode& node, std::string_view what, Quantity quantity) {
  const auto numbers = numbers_of(node, what, quantity, 3);
  return {numbers[0], numbers[1], numbers[2]};
}

Fields::Fields(const YamlNode& map, std::string_view what, std::initializer_list<const char*> keys,
               ReadFaults& faults)
    : map_(map), what_(what), faults_(faults) {
  if (map.kind != YamlNode::Kind::map) {
    throw ReadFault{map.place, text(msg::program_expected_fields, what)};
  }
  const std::vector<std::string> known(keys.begin(), keys.end());
  for (const auto& [key, value] : map.members) {
    if (std::ranges::find(known, key.text) != known.end()) continue;
    if (unknown_.line == 0) unknown_ = key.place;
    const std::optional<std::string> near = nearest_word(key.text, known);
    if (near) meant_.push_back(*near);
    note(faults, {key.place, text(msg::program_unknown_key, what, key.text) +
                                 (near ? did_you_mean(key.text, known)
                                       : text(msg::program_known_keys, listed(known)))});
  }
}

const YamlNode* Fields::find(std::string_view key) const {
  for (const auto& [name, value] : map_.members) {
    if (name.text == key) return &value;
  }
  return nullptr;
}

const YamlNode& Fields::need(std::string_view key) const {
  const YamlNode* node = find(key);
  if (node == nullptr) miss({key}, text(msg::program_missing, what_, key));
  return *node;
}

void Fields::miss(std::initializer_list<std::string_view> keys, const std::string& what) const {
  const bool misspelt = std::ranges::any_of(
      meant_, [&](const std::string& word) { return std::ranges::find(keys, word) != keys.end(); });
  // What nothing knows is told before what is missing beside it.
  const FilePlace place = unknown_.line > 0 ? unknown_ : map_.place;
  throw ReadFault{place, misspelt ? std::string() : what};
}

std::string Fields::named(std::string_view key) const {
  return text(msg::core_at_place, what_, key);
}

std::optional<double> Fields::positive(std::string_view key, Quantity quantity, double max) const {
  const YamlNode* node = find(key);
  if (node == nullptr) return std::nullopt;
  return or_noted(faults_, std::optional<double>(), [&]() -> std::optional<double> {
    return positive_of(*node, named(key), quantity, max);
  });
}

std::optional<double> Fields::not_negative(std::string_view key, Quantity quantity) const {
  const YamlNode* node = find(key);
  if (node == nullptr) return std::nullopt;
  return or_noted(faults_, std::optional<double>(), [&]() -> std::optional<double> {
    const double value = number_of(*node, named(key), quantity);
    if (value >= 0) return value;
    throw ReadFault{node->place, text(msg::program_negative, named(key), value)};
  });
}

Eigen::Vector3d Fields::vector(std::string_view key, Quantity quantity) const {
  const auto read = [&](const YamlNode& node, const std::string& what) -> Eigen::Vector3d {
    return vector_of(node, what, quantity);
  };
  return take(key, Eigen::Vector3d(Eigen::Vector3d::UnitZ()), read);
}

Eigen::Matrix3d Fields::rotation() const {
  const bool given = find("euler") || find("quat") || find("matrix");
  if (!given) miss({"euler", "quat", "matrix"}, text(msg::program_missing_rotation, what_));
  return or_noted(faults_, Eigen::Matrix3d(Eigen::Matrix3d::Identity()),
                  [this] { return read_rotation(); });
}

Eigen::Matrix3d Fields::read_rotation() const {
  const YamlNode* given = nullptr;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  const std::pair<const char*, Eigen::Matrix3d (*)(const YamlNode&, const std::string&)> ways[] = {
      {"euler", euler_of}, {"quat", quat_of}, {"matrix", matrix_of}};
  for (const auto& [key, read] : ways) {
    const YamlNode* node = find(key);
    if (node == nullptr) continue;
    if (given != nullptr) throw ReadFault{node->place, text(msg::program_two_rotations, what_)};
    given = node;
    R = read(*node, named(key));
  }
  return R;
}

FrameName Fields::frame() const {
  const YamlNode* node = find("frame");
  if (node == nullptr) return {};
  return or_noted(faults_, FrameName{},
                  [&] { return FrameName{text_of(*node, named("frame")), node->place}; });
}

ProgramPose pose_of(const Fields& fields, const NamedThings& named) {
  const YamlNode* name = fields.find("pose");
  if (name == nullptr) {
    const Eigen::Vector3d p = fields.vector("pos", Quantity::length);
    return {{p, fields.rotation()}, fields.frame()};
  }
  for (const char* other : {"pos", "euler", "quat", "matrix", "frame"}) {
    if (const YamlNode* node = fields.find(other)) {
      throw ReadFault{node->place, text(msg::program_pose_and, fields.named("pose"), other)};
    }
  }
  return look_up(named.poses, *name, fields.named("pose"), msg::program_unknown_pose);
}

ProgramPose pose_of(const YamlNode& node, std::string_view what, const NamedThings& named) {
  if (node.kind == YamlNode::Kind::scalar) {
    return look_up(named.poses, node, what, msg::program_unknown_pose);
  }
  return pose_of(Fields(node, what, {MJARM_POSE_KEYS}, named.faults), named);
}

JointValues joints_of(const YamlNode& node, std::string_view what, const NamedThings& named) {
  if (node.kind == YamlNode::Kind::scalar) {
    return look_up(named.postures, node, what, msg::program_unknown_posture);
  }
  // What each joint measures is known only with the robot.
  static constexpr Quantity kUnits[] = {Quantity::angle, Quantity::length};
  JointValues out;
  for (const YamlNode& item : list_of(node, what, 0)) {
    if (item.kind != YamlNode::Kind::scalar || item.quoted) {
      throw ReadFault{item.place, text(msg::program_expected_number, what)};
    }
    const Result<WrittenNumber> value = parse_written(item.text, kUnits);
    if (!value) throw ReadFault{item.place, text(msg::program_in, what, value.error().what)};
    out.values.push_back(value->value);
    out.units.push_back(value->unit);
  }
  return out;
}

}  // namespace mjarm::program::detail
