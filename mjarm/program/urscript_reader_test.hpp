#pragma once

#include <cctype>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace mjarm::testing {

/// One call of a script: `movel(p[...], a=1.0, v=0.25)`.
struct UrStatement {
  std::string word;
  std::vector<std::vector<double>> lists;  ///< in order; poses have `p` in `kinds`
  std::string kinds;                       ///< of `lists`: 'p' pose, 'q' joint values
  std::vector<double> numbers;             ///< without a name; True is 1
  std::map<std::string, double> named;
  std::string comment;  ///< the last one before it
};

struct UrScript {
  std::string name;
  std::vector<UrStatement> statements;
};

/// Reads the part of URScript that an exported program may use; knows nothing of how it is written.
/// @throws std::runtime_error with the line of what it does not understand.
class UrReader {
 public:
  static UrScript read(const std::string& text) {
    UrReader reader(text);
    return reader.script();
  }

 private:
  explicit UrReader(const std::string& text) {
    std::string line;
    for (const char c : text) {
      if (c == '\n') {
        lines_.push_back(std::move(line));
        line.clear();
      } else {
        if (c < ' ' || c > '~') throw std::runtime_error("no plain character");
        line += c;
      }
    }
    if (!line.empty()) throw std::runtime_error("no end of the last line");
  }

  [[noreturn]] void no(const std::string& what) const {
    throw std::runtime_error("line " + std::to_string(at_line_ + 1) + ": " + what);
  }
  const std::string& line() const {
    if (at_line_ >= lines_.size()) no("the script ends");
    return lines_[at_line_];
  }

  UrScript script() {
    UrScript out;
    const std::string& first = line();
    if (first.rfind("def ", 0) != 0 || first.substr(first.size() - 3) != "():") no("no def");
    out.name = first.substr(4, first.size() - 7);
    for (std::size_t i = 0; i < out.name.size(); ++i) {
      const char c = out.name[i];
      if (!std::isalpha(c) && c != '_' && (i == 0 || !std::isdigit(c))) no("no identifier");
    }
    std::string comment;
    for (++at_line_; line() != "end"; ++at_line_) {
      if (line().rfind("  ", 0) != 0) no("not indented");
      at_ = 2;
      if (peek() == '#') {
        comment = line().substr(4);
        continue;
      }
      out.statements.push_back(statement());
      out.statements.back().comment = comment;
    }
    ++at_line_;
    if (line() != out.name + "()") no("no call");
    if (at_line_ + 1 != lines_.size()) no("something after the call");
    return out;
  }

  char peek() const { return at_ < line().size() ? line()[at_] : '\0'; }
  bool take(const std::string& text) {
    if (line().compare(at_, text.size(), text) != 0) return false;
    at_ += text.size();
    return true;
  }
  void expect(const std::string& text) {
    if (!take(text)) no("expected " + text);
  }

  std::string word() {
    std::string out;
    while (std::isalnum(peek()) || peek() == '_') out += line()[at_++];
    if (out.empty() || std::isdigit(out[0])) no("expected a word");
    return out;
  }

  double number() {
    std::string digits;
    if (take("-")) digits = "-";
    while (std::isdigit(peek()) || peek() == '.') digits += line()[at_++];
    std::size_t used = 0;
    double out = 0;
    try {
      out = std::stod(digits, &used);
    } catch (const std::exception&) {
      no("expected a number");
    }
    if (used != digits.size()) no("expected a number");
    return out;
  }

  std::vector<double> list() {
    expect("[");
    std::vector<double> out{number()};
    while (take(", ")) out.push_back(number());
    expect("]");
    return out;
  }

  UrStatement statement() {
    UrStatement out;
    out.word = word();
    expect("(");
    do {
      argument(out);
    } while (take(", "));
    expect(")");
    if (peek() != '\0') no("something after the call");
    return out;
  }

  void argument(UrStatement& out) {
    if (peek() == '[' || line().compare(at_, 2, "p[") == 0) {
      out.kinds += take("p") ? 'p' : 'q';
      out.lists.push_back(list());
      if (out.lists.back().size() != 6) no("expected six numbers");
    } else if (take("True")) {
      out.numbers.push_back(1);
    } else if (take("False")) {
      out.numbers.push_back(0);
    } else if (std::isalpha(peek())) {
      const std::string name = word();
      expect("=");
      if (!out.named.emplace(name, number()).second) no(name + " twice");
    } else {
      out.numbers.push_back(number());
    }
  }

  std::vector<std::string> lines_;
  std::size_t at_line_ = 0;
  std::size_t at_ = 0;
};

}  // namespace mjarm::testing
