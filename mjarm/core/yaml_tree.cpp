#include "mjarm/core/yaml_tree.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "mjarm/core/messages/core.hpp"

namespace mjarm {
namespace {

constexpr std::size_t kMaxLevels = 32;
constexpr std::size_t kMaxNodes = 200'000;

/// What ends the reading; never leaves this file.
struct Stop {
  FilePlace place;
  std::string what;
};

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
    if (found == anchors_.end()) throw Stop{place_of(mark), text(msg::core_yaml_bad_alias)};
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
  };

  void open(YamlNode::Kind kind, const YAML::Mark& mark, YAML::anchor_t anchor) {
    if (open_.size() >= kMaxLevels) {
      throw Stop{place_of(mark), text(msg::core_yaml_too_deep, kMaxLevels)};
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
      check_key(parent.node, node);
      parent.key = std::move(node);
      parent.has_key = true;
    } else {
      parent.node.members.emplace_back(std::move(parent.key), std::move(node));
      parent.has_key = false;
    }
  }

  void count(FilePlace place, std::size_t nodes) {
    count_ += nodes;
    if (count_ > kMaxNodes) throw Stop{place, text(msg::core_yaml_too_many_nodes, kMaxNodes)};
  }

  static void check_key(const YamlNode& map, const YamlNode& key) {
    if (key.kind != YamlNode::Kind::scalar) throw Stop{key.place, text(msg::core_yaml_key_no_word)};
    const auto same = [&](const auto& member) { return member.first.text == key.text; };
    if (std::ranges::any_of(map.members, same)) {
      throw Stop{key.place, text(msg::core_yaml_key_twice, key.text)};
    }
  }

  YamlNode root_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, YamlNode> anchors_;
  std::size_t count_ = 0;
};

}  // namespace

std::string at_place(std::string_view name, FilePlace place, std::string_view what) {
  std::string out(name);
  if (place.line > 0) out += ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
  return out.append(out.empty() ? "" : ": ").append(what);
}

Result<YamlNode> read_yaml(const std::string& content, std::string_view name) {
  TreeBuilder builder;
  try {
    std::istringstream stream(content);
    YAML::Parser parser(stream);
    if (!parser.HandleNextDocument(builder)) return YamlNode{};
    YamlNode root = builder.take();
    TreeBuilder second;
    if (parser.HandleNextDocument(second)) {
      return fail(Errc::bad_input,
                  at_place(name, second.take().place, text(msg::core_yaml_two_documents)));
    }
    return root;
  } catch (const Stop& stop) {
    return fail(Errc::bad_input, at_place(name, stop.place, stop.what));
  } catch (const YAML::Exception& exception) {
    return fail(Errc::bad_input, at_place(name, place_of(exception.mark),
                                          text(msg::core_yaml_syntax, exception.msg)));
  }
}

}  // namespace mjarm
