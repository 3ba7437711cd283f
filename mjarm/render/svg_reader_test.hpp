#pragma once

#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace mjarm::testing {

/// One element of a picture, in the order of drawing.
struct SvgElement {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::string text;     ///< directly inside it, entities resolved
  std::string parents;  ///< names of the elements it stands in: "svg/g"

  [[nodiscard]] double number(const std::string& key) const {
    return std::stod(attributes.at(key));
  }
  [[nodiscard]] bool is(const std::string& key, const std::string& value) const {
    const auto found = attributes.find(key);
    return found != attributes.end() && found->second == value;
  }
  /// Of a polyline: x and y.
  [[nodiscard]] std::vector<std::pair<double, double>> points() const {
    std::vector<std::pair<double, double>> out;
    std::istringstream numbers(attributes.at("points"));
    std::pair<double, double> p;
    for (char comma = 0; numbers >> p.first >> comma >> p.second;) {
      if (comma != ',') throw std::runtime_error("points without a comma");
      out.push_back(p);
    }
    if (!numbers.eof()) throw std::runtime_error("no numbers: " + attributes.at("points"));
    return out;
  }
};

/// Reads the part of XML that pictures are written in, strictly; knows nothing of plots.
/// @throws std::runtime_error at the first character that is not well-formed.
class SvgReader {
 public:
  static std::vector<SvgElement> read(const std::string& text) { return SvgReader(text).all(); }

 private:
  explicit SvgReader(const std::string& text) : text_(text) {}

  [[noreturn]] void no(const std::string& what) const {
    throw std::runtime_error("at " + std::to_string(at_) + ": " + what);
  }
  [[nodiscard]] bool take(const std::string& word) {
    if (text_.compare(at_, word.size(), word) != 0) return false;
    at_ += word.size();
    return true;
  }
  void expect(const std::string& word) {
    if (!take(word)) no("expected " + word);
  }
  std::string until(const std::string& end) {
    const std::size_t found = text_.find(end, at_);
    if (found == std::string::npos) no("no " + end);
    std::string out = text_.substr(at_, found - at_);
    at_ = found + end.size();
    return out;
  }
  std::string name() {
    std::string out;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 ||
                                  text_[at_] == '-' || text_[at_] == ':')) {
      out += text_[at_++];
    }
    if (out.empty()) no("expected a name");
    return out;
  }
  std::string resolved(const std::string& raw) const {
    static const std::pair<const char*, char> kEntities[] = {
        {"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}};
    std::string out;
    for (std::size_t i = 0; i < raw.size();) {
      if (raw[i] == '<' || static_cast<unsigned char>(raw[i]) < 9) no("not escaped: " + raw);
      if (raw[i] != '&') {
        out += raw[i++];
        continue;
      }
      bool known = false;
      for (const auto& [entity, letter] : kEntities) {
        if (raw.compare(i, std::string(entity).size(), entity) != 0) continue;
        out += letter;
        i += std::string(entity).size();
        known = true;
        break;
      }
      if (!known) no("a bare & in " + raw);
    }
    return out;
  }

  std::vector<SvgElement> all() {
    expect("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    std::vector<std::size_t> open;
    while (at_ < text_.size()) {
      if (take("</")) {
        if (open.empty() || out_[open.back()].name != until(">")) no("closes another element");
        open.pop_back();
      } else if (take("<")) {
        if (open.empty() && !out_.empty()) no("a second root");
        element(open);
      } else {
        const std::string text = text_.substr(at_, text_.find('<', at_) - at_);
        if (open.empty() && text != "\n") no("text outside of the root");
        if (!open.empty()) out_[open.back()].text += resolved(text);
        at_ += text.size();
      }
    }
    if (!open.empty()) no("an element is not closed");
    return out_;
  }

  void element(std::vector<std::size_t>& open) {
    SvgElement made;
    made.name = name();
    for (const std::size_t parent : open) made.parents += out_[parent].name + "/";
    while (take(" ")) {
      const std::string key = name();
      expect("=\"");
      if (!made.attributes.emplace(key, resolved(until("\""))).second) no(key + " twice");
    }
    const bool closed = take("/>");
    if (!closed) expect(">");
    if (!closed) open.push_back(out_.size());
    out_.push_back(std::move(made));
  }

  const std::string& text_;
  std::size_t at_ = 0;
  std::vector<SvgElement> out_;
};

}  // namespace mjarm::testing
