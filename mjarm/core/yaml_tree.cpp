#include "mjarm/core/yaml_tree.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "mjarm/core/messages/core.hpp"

namespace mjarm {
namespace {

constexpr std::size_t kMaxLevels = 32;
constexpr std::size_t kMaxNodes = 200'000;

FilePlace place_of(const YAML::Mark& mark) {
  return mark.is_null() ? FilePlace{} : FilePlace{mark.line + 1, mark.column + 1};
}

std::size_t count_nodes(const YamlNode& node) {
  std::size_t count = 1;
  for (const YamlNode& item : node.items) count += count_nodes(item);
  for (const auto& [key, value] : node.members) count += 1 + count_nodes(value);
  return count;
}

/// Grows the tree as yaml-cpp reports what it reads.
class TreeBuilder : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    // The parser has gone on to whatever comes next; what is left out is missed at its key.
    const bool has_key = !open_.empty() && open_.back().has_key;
    const FilePlace place = has_key ? open_.back().key.place : place_of(mark);
    add({YamlNode::Kind::nothing, place, {}, false, {}, {}}, anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) throw YamlFault{place_of(mark), text(msg::core_yaml_bad_alias)};
    count(place_of(mark), count_nodes(found->second));
    add(found->second, 0);
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    add({YamlNode::Kind::scalar, place_of(mark), value, tag != "?", {}, {}}, anchor);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(YamlNode::Kind::list, mark, anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(YamlNode::Kind::map, mark, anchor);
  }
  void OnMapEnd() override { close(); }

  YamlNode take() { return std::move(root_); }

 private:
  /// A list or map that is not complete yet, and in a map the key whose value comes.
  struct Open {
    YamlNode node;
    YAML::anchor_t anchor = 0;
    bool has_key = false;
    YamlNode key = {};
    std::unordered_set<std::string> keys = {};  ///< of a map, so far
  };

  void open(YamlNode::Kind kind, const YAML::Mark& mark, YAML::anchor_t anchor) {
    if (open_.size() >= kMaxLevels) {
      throw YamlFault{place_of(mark), text(msg::core_yaml_too_deep, kMaxLevels)};
    }
    Open begun;
    begun.node.kind = kind;
    begun.node.place = place_of(mark);
    begun.anchor = anchor;
    open_.push_back(std::move(begun));
  }

  void close() {
    Open done = std::move(open_.back());
    open_.pop_back();
    add(std::move(done.node), done.anchor);
  }

  void add(YamlNode node, YAML::anchor_t anchor) {
    count(node.place, 1);
    if (anchor != 0) {
      count(node.place, count_nodes(node));
      anchors_[anchor] = node;
    }
    if (open_.empty()) {
      root_ = std::move(node);
      return;
    }
    Open& parent = open_.back();
    if (parent.node.kind == YamlNode::Kind::list) {
      parent.node.items.push_back(std::move(node));
    } else if (!parent.has_key) {
      check_key(parent.keys, node);
      parent.key = std::move(node);
      parent.has_key = true;
    } else {
      parent.node.members.push_back({std::move(parent.key), std::move(node)});
      parent.has_key = false;
    }
  }

  void count(FilePlace place, std::size_t nodes) {
    count_ += nodes;
    if (count_ > kMaxNodes) throw YamlFault{place, text(msg::core_yaml_too_many_nodes, kMaxNodes)};
  }

  static void check_key(std::unordered_set<std::string>& known, const YamlNode& key) {
    if (key.kind != YamlNode::Kind::scalar)
      throw YamlFault{key.place, text(msg::core_yaml_key_no_word)};
    if (!known.insert(key.text).second) {
      throw YamlFault{key.place, text(msg::core_yaml_key_twice, key.text)};
    }
  }

  YamlNode root_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, YamlNode> anchors_;
  std::size_t count_ = 0;
};

/// What the library found wrong, in words of ours. Its own are a parser's, and English.
std::string fault_of(std::string_view words) {
  struct Known {
    std::string_view theirs;  ///< how their message begins
    Msg ours;
  };
  namespace yaml = YAML::ErrorMsg;
  static const Known kKnown[] = {{yaml::MAP_VALUE, msg::core_yaml_no_map_value},
                                 {yaml::MAP_KEY, msg::core_yaml_no_map_value},
                                 {yaml::END_OF_MAP_FLOW, msg::core_yaml_open_brace},
                                 {yaml::END_OF_SEQ_FLOW, msg::core_yaml_open_bracket},
                                 {yaml::END_OF_MAP, msg::core_yaml_no_map_end},
                                 {yaml::END_OF_SEQ, msg::core_yaml_no_seq_end},
                                 {yaml::FLOW_END, msg::core_yaml_closes_nothing},
                                 {yaml::BLOCK_ENTRY, msg::core_yaml_dash},
                                 {yaml::TAB_IN_INDENTATION, msg::core_yaml_tab},
                                 {yaml::EOF_IN_SCALAR, msg::core_yaml_quote},
                                 {yaml::DOC_IN_SCALAR, msg::core_yaml_quote},
                                 {yaml::INVALID_ESCAPE, msg::core_yaml_escape},
                                 {yaml::INVALID_HEX, msg::core_yaml_escape},
                                 {yaml::INVALID_UNICODE, msg::core_yaml_escape},
                                 {yaml::UNKNOWN_TOKEN, msg::core_yaml_char},
                                 {yaml::CHAR_IN_SCALAR, msg::core_yaml_char},
                                 {yaml::ALIAS_NOT_FOUND, msg::core_yaml_anchor},
                                 {yaml::ANCHOR_NOT_FOUND, msg::core_yaml_anchor},
                                 {yaml::CHAR_IN_ALIAS, msg::core_yaml_anchor},
                                 {yaml::CHAR_IN_ANCHOR, msg::core_yaml_anchor},
                                 {yaml::UNKNOWN_ANCHOR, msg::core_yaml_bad_alias},
                                 {yaml::CHAR_IN_BLOCK, msg::core_yaml_block},
                                 {yaml::ZERO_INDENT_IN_BLOCK, msg::core_yaml_block},
                                 {yaml::TAG_WITH_NO_SUFFIX, msg::core_yaml_tag},
                                 {yaml::END_OF_VERBATIM_TAG, msg::core_yaml_tag},
                                 {yaml::CHAR_IN_TAG_HANDLE, msg::core_yaml_tag},
                                 {yaml::YAML_DIRECTIVE_ARGS, msg::core_yaml_directive},
                                 {yaml::YAML_VERSION, msg::core_yaml_directive},
                                 {yaml::YAML_MAJOR_VERSION, msg::core_yaml_directive},
                                 {yaml::REPEATED_YAML_DIRECTIVE, msg::core_yaml_directive},
                                 {yaml::TAG_DIRECTIVE_ARGS, msg::core_yaml_directive},
                                 {yaml::REPEATED_TAG_DIRECTIVE, msg::core_yaml_directive}};
  for (const Known& known : kKnown) {
    if (words.starts_with(known.theirs)) return text(known.ours);
  }
  return text(msg::core_yaml_broken);
}

/// The innermost bracket that is still open where `line` begins, or that another one on it would
/// close; none where there is no such. Texts in quotes and comments are left out.
std::optional<std::pair<char, FilePlace>> open_bracket(std::string_view content, int line) {
  std::vector<std::pair<char, FilePlace>> open;
  std::size_t open_before = 0;
  char quote = 0, before = '\n';  // the sign before, blanks left out
  FilePlace at{1, 0};
  for (std::size_t i = 0; i < content.size() && at.line <= line; ++i) {
    const char sign = content[i];
    constexpr unsigned kInside = 0x80;  // bytes of a character behind its first
    if ((static_cast<unsigned>(sign) & 0xC0U) != kInside) ++at.column;
    if (sign == '\n') {
      if (++at.line == line) open_before = open.size();
      at.column = 0;
      if (quote == 0) before = sign;
      continue;
    }
    const bool begins =
        !open.empty() || std::string_view("\n:-,").find(before) != std::string::npos;
    if (quote != 0) {
      if (sign == quote) quote = 0;
    } else if (sign == '#' &&
               (i == 0 || std::string_view(" \t\n").find(content[i - 1]) != std::string::npos)) {
      i = std::min(content.find('\n', i), content.size()) - 1;
    } else if (begins && (sign == '"' || sign == '\'')) {
      quote = sign;
    } else if (begins && (sign == '{' || sign == '[')) {
      open.emplace_back(sign, at);
    } else if (!open.empty() && (sign == '}' || sign == ']')) {
      if (open.back().first != (sign == '}' ? '{' : '[')) return open.back();
      open.pop_back();
      open_before = std::min(open_before, open.size());
    }
    if (sign != ' ') before = sign;
  }
  if (open_before == 0) return std::nullopt;
  return open[open_before - 1];
}

/// What is wrong, and where: tabs and brackets by themselves, as a parser notices them too late.
YamlFault fault_at(const std::string& content, const YAML::Exception& exception) {
  const FilePlace place = place_of(exception.mark);
  const auto what = [](Msg found) { return text(msg::core_yaml_syntax, text(found)); };
  std::size_t begin = 0;
  for (int line = 1; line < place.line; ++line) begin = content.find('\n', begin) + 1;
  const std::size_t blanks = std::min(content.find_first_not_of(" \t", begin), content.size());
  const std::size_t tab = content.find('\t', begin);
  if (tab < blanks) {
    return {{place.line, static_cast<int>(tab - begin) + 1}, what(msg::core_yaml_tab)};
  }
  if (const auto bracket = open_bracket(content, place.line)) {
    return {bracket->second,
            what(bracket->first == '{' ? msg::core_yaml_open_brace : msg::core_yaml_open_bracket)};
  }
  return {place, text(msg::core_yaml_syntax, fault_of(exception.msg))};
}

}  // namespace

std::string at_place(std::string_view name, FilePlace place, std::string_view what) {
  std::string out(name);
  if (place.line > 0) out += ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
  return out.empty() ? std::string(what) : text(msg::core_at_place, out, what);
}

Result<YamlNode, YamlFault> read_yaml(const std::string& content) {
  TreeBuilder builder;
  try {
    std::istringstream stream(content);
    YAML::Parser parser(stream);
    if (!parser.HandleNextDocument(builder)) return YamlNode{};
    YamlNode root = builder.take();
    TreeBuilder second;
    if (parser.HandleNextDocument(second)) {
      return tl::unexpected(YamlFault{second.take().place, text(msg::core_yaml_two_documents)});
    }
    return root;
  } catch (const YamlFault& fault) {
    return tl::unexpected(fault);
  } catch (const YAML::Exception& exception) {
    return tl::unexpected(fault_at(content, exception));
  }
}

Result<YamlNode> read_yaml(const std::string& content, std::string_view name) {
  return read_yaml(content).map_error([&](const YamlFault& fault) {
    return Error{Errc::bad_input, at_place(name, fault.place, fault.what)};
  });
}

}  // namespace mjarm
