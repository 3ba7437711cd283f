#include "mjarm/core/yaml_tree.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <sstream>
#include <string>
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
    return tl::unexpected(
        YamlFault{place_of(exception.mark), text(msg::core_yaml_syntax, fault_of(exception.msg))});
  }
}

Result<YamlNode> read_yaml(const std::string& content, std::string_view name) {
  return read_yaml(content).map_error([&](const YamlFault& fault) {
    return Error{Errc::bad_input, at_place(name, fault.place, fault.what)};
  });
}

}  // namespace mjarm
