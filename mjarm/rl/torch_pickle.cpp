#include <algorithm>
#include <optional>

#include "mjarm/core/byte_order.hpp"
#include "mjarm/core/messages/policy_file.hpp"
#include "mjarm/rl/json_internal.hpp"
#include "mjarm/rl/pickle_opcodes_internal.hpp"
#include "mjarm/rl/torch_pickle_internal.hpp"

namespace mjarm::rl {
namespace {

// What weights need by far, and what memory can always hold.
constexpr std::size_t kLargestPickle = std::size_t{4} << 20;
constexpr std::size_t kMaxValues = 1 << 18;
constexpr std::size_t kDeepestStack = 4096;
constexpr std::size_t kMaxMarks = 32;
constexpr std::size_t kMaxMemos = 1 << 17;

enum class PickleKind { none, truth, integer, words, global, tuple, dict, storage, tensor };

constexpr const char* kOrderedDict = "collections.OrderedDict";
constexpr const char* kRebuildTensor = "torch._utils._rebuild_tensor_v2";
constexpr const char* kFloatStorage = "torch.FloatStorage";

/// A value is known by its place in the list of all values: they may refer to each other in
/// circles, and none goes before the end.
using ValueId = std::size_t;

struct PickleValue {
  PickleKind kind = PickleKind::none;
  std::int64_t number = 0;          ///< of an integer; numbers in a storage
  std::string words = {};           ///< a text; a global's full name; a storage's name
  std::vector<ValueId> items = {};  ///< of a tuple; of a dict its keys and values in turn; of a
                                    ///< tensor what it is rebuilt from
};

class TorchPickle {
 public:
  TorchPickle(std::string_view bytes, const std::string& source) : bytes_(bytes), source_(source) {}

  Result<std::map<std::string, PickledTensor>> read();

 private:
  /// What an instruction did: nullopt where all is well, else the message that says why not.
  using Refusal = std::optional<Error>;

  Refusal run(unsigned char code);
  Refusal run_on_stack(unsigned char code);
  Refusal add_global();
  Refusal add_tuple(std::size_t first);
  Refusal add_storage();
  Refusal set_items(std::size_t first);
  Refusal build();
  Refusal reduce();
  Refusal put(std::size_t index);
  Refusal get(std::size_t index);
  Refusal add(PickleValue value);
  Refusal push(ValueId id);

  Error misfit() const {
    return {Errc::bad_input,
            text(msg::policy_file_pickle_misfit, source_, pickle_op_name(code_), start_)};
  }
  Error too_much(const char* what) const {
    return {Errc::bad_input, text(msg::policy_file_pickle_large, source_, what, start_)};
  }
  Error refused_global(const std::string& name) const {
    return {Errc::bad_input,
            text(msg::policy_file_pickle_global, source_, in_quotes(name),
                 std::string(kOrderedDict) + ", " + kRebuildTensor + ", " + kFloatStorage)};
  }

  /// The next `count` bytes; fewer where the pickle ends, which `cut_` then tells.
  std::string_view take(std::size_t count);
  template <class Number>
  Number take_number();
  std::string_view take_line();
  /// Values that an instruction may take: those after the last mark.
  std::size_t available() const { return stack_.size() - (marks_.empty() ? 0 : marks_.back()); }
  PickleValue& top(std::size_t below = 0) { return values_[stack_[stack_.size() - 1 - below]]; }
  bool top_is(PickleKind kind, std::size_t below = 0) {
    return available() > below && top(below).kind == kind;
  }

  Result<PickledTensor> tensor(const PickleValue& value) const;
  std::optional<std::vector<std::int64_t>> integers(const PickleValue& tuple) const;

  std::string_view bytes_;
  const std::string& source_;
  std::size_t at_ = 0;     ///< of the next byte
  std::size_t start_ = 0;  ///< of the instruction that runs
  unsigned char code_ = 0;
  bool cut_ = false;
  std::vector<PickleValue> values_;
  std::vector<ValueId> stack_;
  std::vector<std::size_t> marks_;  ///< heights of the stack
  std::map<std::size_t, ValueId> memo_;
};

std::string_view TorchPickle::take(std::size_t count) {
  if (count > bytes_.size() - at_) {
    cut_ = true;
    count = bytes_.size() - at_;
  }
  at_ += count;
  return bytes_.substr(at_ - count, count);
}

template <class Number>
Number TorchPickle::take_number() {
  const std::string_view taken = take(sizeof(Number));
  return cut_ ? Number{} : load_little<Number>(taken);
}

std::string_view TorchPickle::take_line() {
  const std::size_t end = bytes_.find('\n', at_);
  const std::string_view line = take(end == std::string_view::npos ? end : end - at_);
  take(1);
  return line;
}

TorchPickle::Refusal TorchPickle::push(ValueId id) {
  if (stack_.size() >= kDeepestStack) return too_much("STACK");
  stack_.push_back(id);
  return std::nullopt;
}

TorchPickle::Refusal TorchPickle::add(PickleValue value) {
  if (values_.size() >= kMaxValues) return too_much("VALUES");
  values_.push_back(std::move(value));
  return push(values_.size() - 1);
}

TorchPickle::Refusal TorchPickle::put(std::size_t index) {
  if (available() == 0) return misfit();
  if (memo_.size() >= kMaxMemos) return too_much("MEMO");
  memo_[index] = stack_.back();
  return std::nullopt;
}

TorchPickle::Refusal TorchPickle::get(std::size_t index) {
  const auto found = memo_.find(index);
  return found == memo_.end() ? misfit() : push(found->second);
}

TorchPickle::Refusal TorchPickle::add_global() {
  const std::string_view module = take_line();
  const std::string_view word = take_line();
  if (cut_) return std::nullopt;
  std::string name = std::string(module) + "." + std::string(word);
  if (name != kOrderedDict && name != kRebuildTensor && name != kFloatStorage) {
    return refused_global(name);
  }
  return add({.kind = PickleKind::global, .words = std::move(name)});
}

/// The values from `first` on become one tuple.
TorchPickle::Refusal TorchPickle::add_tuple(std::size_t first) {
  PickleValue tuple{.kind = PickleKind::tuple};
  tuple.items.assign(stack_.begin() + static_cast<std::ptrdiff_t>(first), stack_.end());
  stack_.resize(first);
  return add(std::move(tuple));
}

/// ("storage", torch.FloatStorage, name, device, count): the device is of no concern.
TorchPickle::Refusal TorchPickle::add_storage() {
  if (!top_is(PickleKind::tuple) || top().items.size() != 5) return misfit();
  const auto item = [&](std::size_t i) -> const PickleValue& { return values_[top().items[i]]; };
  const bool known = item(0).kind == PickleKind::words && item(0).words == "storage" &&
                     item(1).kind == PickleKind::global && item(1).words == kFloatStorage &&
                     item(2).kind == PickleKind::words && item(3).kind == PickleKind::words &&
                     item(4).kind == PickleKind::integer;
  if (!known) return misfit();
  PickleValue storage{
      .kind = PickleKind::storage, .number = item(4).number, .words = item(2).words};
  stack_.pop_back();
  return add(std::move(storage));
}

/// Keys and values from `first` on go into the dict below them.
TorchPickle::Refusal TorchPickle::set_items(std::size_t first) {
  if (available() == 0 || first == 0 || (stack_.size() - first) % 2 != 0) return misfit();
  PickleValue& dict = values_[stack_[first - 1]];
  if (dict.kind != PickleKind::dict) return misfit();
  for (std::size_t i = first; i < stack_.size(); ++i) {
    if ((i - first) % 2 == 0 && values_[stack_[i]].kind != PickleKind::words) return misfit();
    dict.items.push_back(stack_[i]);
  }
  stack_.resize(first);
  return std::nullopt;
}

/// An OrderedDict gets attributes, "_metadata" with the versions of modules: nobody needs them.
TorchPickle::Refusal TorchPickle::build() {
  if (!top_is(PickleKind::dict) || !top_is(PickleKind::dict, 1)) return misfit();
  stack_.pop_back();
  return std::nullopt;
}

TorchPickle::Refusal TorchPickle::reduce() {
  if (!top_is(PickleKind::tuple) || !top_is(PickleKind::global, 1)) return misfit();
  std::vector<ValueId> arguments = top().items;
  const std::string name = top(1).words;
  PickleValue made;
  if (name == kOrderedDict && arguments.empty()) {
    made.kind = PickleKind::dict;
  } else if (name == kRebuildTensor && arguments.size() >= 6 && arguments.size() <= 7) {
    made.kind = PickleKind::tensor;
    made.items = std::move(arguments);
  } else {
    return misfit();
  }
  stack_.resize(stack_.size() - 2);
  return add(std::move(made));
}

/// Instructions that take values from the stack.
TorchPickle::Refusal TorchPickle::run_on_stack(unsigned char code) {
  switch (static_cast<PickleOp>(code)) {
    case PickleOp::tuple:
    case PickleOp::set_items: {
      if (marks_.empty()) return misfit();
      const std::size_t first = marks_.back();
      marks_.pop_back();
      return static_cast<PickleOp>(code) == PickleOp::tuple ? add_tuple(first) : set_items(first);
    }
    case PickleOp::tuple1:
    case PickleOp::tuple2:
    case PickleOp::tuple3: {
      const std::size_t count = code - static_cast<unsigned char>(PickleOp::tuple1) + 1u;
      return available() < count ? misfit() : add_tuple(stack_.size() - count);
    }
    case PickleOp::set_item:
      return available() < 3 ? misfit() : set_items(stack_.size() - 2);
    case PickleOp::reduce:
      return reduce();
    case PickleOp::build:
      return build();
    case PickleOp::bin_pers_id:
      return add_storage();
    default:
      return Error{Errc::bad_input,
                   text(msg::policy_file_pickle_opcode, source_, pickle_op_name(code), start_)};
  }
}

TorchPickle::Refusal TorchPickle::run(unsigned char code) {
  switch (static_cast<PickleOp>(code)) {
    case PickleOp::proto:
      return take_number<std::uint8_t>() == 2 || cut_ ? Refusal() : misfit();
    case PickleOp::mark:
      if (marks_.size() >= kMaxMarks) return too_much("MARK");
      marks_.push_back(stack_.size());
      return std::nullopt;
    case PickleOp::global:
      return add_global();
    case PickleOp::none:
      return add({});
    case PickleOp::new_true:
    case PickleOp::new_false:
      return add({.kind = PickleKind::truth});
    case PickleOp::bin_int:
      return add({.kind = PickleKind::integer, .number = take_number<std::int32_t>()});
    case PickleOp::bin_int1:
      return add({.kind = PickleKind::integer, .number = take_number<std::uint8_t>()});
    case PickleOp::bin_int2:
      return add({.kind = PickleKind::integer, .number = take_number<std::uint16_t>()});
    case PickleOp::bin_unicode: {
      const std::size_t size = take_number<std::uint32_t>();
      return add({.kind = PickleKind::words, .words = std::string(take(size))});
    }
    case PickleOp::empty_tuple:
      return add({.kind = PickleKind::tuple});
    case PickleOp::empty_dict:
      return add({.kind = PickleKind::dict});
    case PickleOp::bin_put:
      return put(take_number<std::uint8_t>());
    case PickleOp::long_bin_put:
      return put(take_number<std::uint32_t>());
    case PickleOp::bin_get:
      return get(take_number<std::uint8_t>());
    case PickleOp::long_bin_get:
      return get(take_number<std::uint32_t>());
    default:
      return run_on_stack(code);
  }
}

std::optional<std::vector<std::int64_t>> TorchPickle::integers(const PickleValue& tuple) const {
  if (tuple.kind != PickleKind::tuple) return std::nullopt;
  std::vector<std::int64_t> numbers;
  for (const ValueId id : tuple.items) {
    if (values_[id].kind != PickleKind::integer) return std::nullopt;
    numbers.push_back(values_[id].number);
  }
  return numbers;
}

/// (storage, offset, shape, strides, requires_grad, hooks[, metadata])
Result<PickledTensor> TorchPickle::tensor(const PickleValue& value) const {
  const auto damaged = fail(Errc::bad_input, text(msg::policy_file_pickle_state, source_));
  if (value.kind != PickleKind::tensor) return damaged;
  const PickleValue& storage = values_[value.items[0]];
  const PickleValue& offset = values_[value.items[1]];
  auto shape = integers(values_[value.items[2]]);
  auto strides = integers(values_[value.items[3]]);
  if (storage.kind != PickleKind::storage || offset.kind != PickleKind::integer || !shape ||
      !strides || shape->size() != strides->size()) {
    return damaged;
  }
  return PickledTensor{.storage = storage.words,
                       .count = storage.number,
                       .offset = offset.number,
                       .shape = std::move(*shape),
                       .strides = std::move(*strides)};
}

Result<std::map<std::string, PickledTensor>> TorchPickle::read() {
  if (bytes_.size() > kLargestPickle) {
    return fail(Errc::bad_input,
                text(msg::policy_file_pickle_size, source_, bytes_.size(), kLargestPickle));
  }
  do {
    start_ = at_;
    code_ = take_number<std::uint8_t>();
    Refusal refusal;
    if (!cut_ && code_ != static_cast<unsigned char>(PickleOp::stop)) refusal = run(code_);
    if (cut_) return fail(Errc::bad_input, text(msg::policy_file_pickle_cut, source_, start_));
    if (refusal) return fail(std::move(*refusal));
  } while (code_ != static_cast<unsigned char>(PickleOp::stop));
  if (at_ != bytes_.size()) {
    return fail(Errc::bad_input, text(msg::policy_file_pickle_after, source_, bytes_.size() - at_));
  }
  const auto damaged = fail(Errc::bad_input, text(msg::policy_file_pickle_state, source_));
  if (stack_.size() != 1 || !marks_.empty() || top().kind != PickleKind::dict) return damaged;
  std::map<std::string, PickledTensor> tensors;
  const std::vector<ValueId>& items = top().items;
  for (std::size_t i = 0; i + 1 < items.size(); i += 2) {
    Result<PickledTensor> found = tensor(values_[items[i + 1]]);
    if (!found) return fail(std::move(found.error()));
    if (!tensors.emplace(values_[items[i]].words, std::move(*found)).second) return damaged;
  }
  return tensors;
}

}  // namespace

Result<std::map<std::string, PickledTensor>> read_torch_pickle(std::string_view pickle,
                                                               const std::string& source) {
  return TorchPickle(pickle, source).read();
}

}  // namespace mjarm::rl
