#include "mjarm/rl/onnx_export.hpp"

#include <cmath>
#include <initializer_list>
#include <optional>
#include <utility>
#include <vector>

#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/policy_file.hpp"
#include "mjarm/rl/json_internal.hpp"
#include "mjarm/rl/protobuf_writer_internal.hpp"

// Messages and their fields: https://github.com/onnx/onnx, onnx/onnx.proto3. What a node computes:
// docs/Operators.md there.
namespace mjarm::rl {
namespace {

constexpr std::int64_t kIrVersion = 8;
constexpr std::int64_t kOpset = 17;
constexpr std::int64_t kFloatType = 1;         // TensorProto.DataType.FLOAT
constexpr std::int64_t kIntegerAttribute = 2;  // AttributeProto.AttributeType.INT

/// Builds the graph of one policy, node after node.
class OnnxGraph {
 public:
  explicit OnnxGraph(const TensorSet& set) : set_(set) {}

  Result<std::string> model();

 private:
  tl::unexpected<Error> bad(const std::string& name) const {
    return fail(Errc::bad_input, text(msg::policy_file_onnx_tensor, in_quotes(name)));
  }
  /// The numbers of a tensor as float32; none where it is missing or has not `count` numbers.
  std::optional<std::vector<double>> numbers(const std::string& name, std::int64_t count) const;
  Result<std::pair<std::int64_t, std::int64_t>> weight_size(int layer) const;

  void constant(const std::string& name, const std::vector<std::int64_t>& shape,
                const std::vector<double>& values);
  void node(const char* type, std::initializer_list<std::string> inputs, const std::string& output,
            const ProtobufMessage* attribute = nullptr);
  Result<void> add_normaliser(std::int64_t observations);
  Result<std::int64_t> add_layers(const std::string& activation);

  const TensorSet& set_;
  ProtobufMessage graph_;             ///< GraphProto
  ProtobufMessage constants_;         ///< its initializers: after the nodes
  std::string last_ = "observation";  ///< what the next node takes
};

ProtobufMessage named_integer(const char* name, std::int64_t value) {
  ProtobufMessage attribute;  // AttributeProto
  attribute.words(1, name).integer(3, value).integer(20, kIntegerAttribute);
  return attribute;
}

/// ValueInfoProto: float32 (batch, size).
ProtobufMessage batch_of(const char* name, std::int64_t size) {
  ProtobufMessage batch, numbers, shape, tensor, type, value;
  shape.message(1, batch.words(2, "batch")).message(1, numbers.integer(1, size));
  tensor.integer(1, kFloatType).message(2, shape);
  return value.words(1, name).message(2, type.message(1, tensor));
}

std::optional<std::vector<double>> OnnxGraph::numbers(const std::string& name,
                                                      std::int64_t count) const {
  const auto found = set_.tensors.find(name);
  if (found == set_.tensors.end()) return std::nullopt;
  auto values =
      std::visit([](const auto& list) { return std::vector<double>(list.begin(), list.end()); },
                 found->second.values);
  if (std::cmp_not_equal(values.size(), count)) return std::nullopt;
  return values;
}

/// (outputs, inputs)
Result<std::pair<std::int64_t, std::int64_t>> OnnxGraph::weight_size(int layer) const {
  const std::string name = "actor." + std::to_string(layer) + ".weight";
  const auto found = set_.tensors.find(name);
  if (found == set_.tensors.end()) return bad(name);
  const auto& shape = found->second.shape;
  if (shape.size() != 2 || shape[0] <= 0 || shape[1] <= 0) return bad(name);
  return std::pair(shape[0], shape[1]);
}

void OnnxGraph::constant(const std::string& name, const std::vector<std::int64_t>& shape,
                         const std::vector<double>& values) {
  ProtobufMessage tensor;  // TensorProto
  for (const std::int64_t size : shape) tensor.integer(1, size);
  std::string raw;
  for (const double value : values) append_little(raw, static_cast<float>(value));
  tensor.integer(2, kFloatType).words(8, name).words(9, raw);
  constants_.message(5, tensor);
}

void OnnxGraph::node(const char* type, std::initializer_list<std::string> inputs,
                     const std::string& output, const ProtobufMessage* attribute) {
  ProtobufMessage node;  // NodeProto
  for (const std::string& input : inputs) node.words(1, input);
  node.words(2, output).words(3, output).words(4, type);
  if (attribute != nullptr) node.message(5, *attribute);
  graph_.message(1, node);
  last_ = output;
}

Result<void> OnnxGraph::add_normaliser(std::int64_t observations) {
  const auto count = numbers("normaliser.count", 1);
  if (!count || !((*count)[0] > 0)) return {};
  const auto mean = numbers("normaliser.mean", observations);
  if (!mean) return bad("normaliser.mean");
  auto scale = numbers("normaliser.variance", observations);
  if (!scale) return bad("normaliser.variance");
  const auto clip = numbers("normaliser.clip", 1);
  if (!clip) return bad("normaliser.clip");
  constexpr double kLeastVariance = 1e-8;  // as Normaliser adds it
  for (double& value : *scale) value = 1 / std::sqrt(value + kLeastVariance);
  constant("mean", {observations}, *mean);
  constant("scale", {observations}, *scale);
  constant("least", {}, {-(*clip)[0]});
  constant("most", {}, {(*clip)[0]});
  node("Sub", {last_, "mean"}, "centred");
  node("Mul", {last_, "scale"}, "scaled");
  node("Clip", {last_, "least", "most"}, "normalised");
  return {};
}

/// Returns the number of actions.
Result<std::int64_t> OnnxGraph::add_layers(const std::string& activation) {
  const ProtobufMessage transposed = named_integer("transB", 1);
  std::int64_t inputs = 0;
  for (int layer = 0;; ++layer) {
    const std::string name = "actor." + std::to_string(layer);
    const auto size = weight_size(layer);
    if (!size) return fail(size.error());
    const auto [rows, cols] = *size;
    const auto weight = numbers(name + ".weight", rows * cols);
    if (!weight || (layer > 0 && cols != inputs)) return bad(name + ".weight");
    const auto bias = numbers(name + ".bias", rows);
    if (!bias) return bad(name + ".bias");
    constant(name + ".weight", {rows, cols}, *weight);
    constant(name + ".bias", {rows}, *bias);
    inputs = rows;
    const bool is_last = !set_.tensors.contains("actor." + std::to_string(layer + 1) + ".weight");
    node("Gemm", {last_, name + ".weight", name + ".bias"}, is_last ? "action" : name, &transposed);
    if (is_last) return rows;
    node(activation == "tanh" ? "Tanh" : "Relu", {last_}, name + "." + activation);
  }
}

Result<std::string> OnnxGraph::model() {
  const auto found = set_.metadata.find("activation");
  const std::string activation = found == set_.metadata.end() ? "" : found->second;
  if (activation != "tanh" && activation != "relu") {
    return fail(Errc::bad_input, text(msg::policy_file_onnx_activation, in_quotes(activation)));
  }
  const auto first = weight_size(0);
  if (!first) return fail(first.error());
  const std::int64_t observations = first->second;
  if (auto done = add_normaliser(observations); !done) return fail(std::move(done.error()));
  const Result<std::int64_t> actions = add_layers(activation);
  if (!actions) return fail(actions.error());
  graph_.words(2, "actor");
  ProtobufMessage graph, opset, model;
  // The order of fields in a message is free, so the parts of the graph can follow each other.
  const std::string parts = graph_.bytes() + constants_.bytes() +
                            graph.message(11, batch_of("observation", observations))
                                .message(12, batch_of("action", *actions))
                                .bytes();
  model.integer(1, kIrVersion).words(2, "mjarm").words(7, parts);
  return model.message(8, opset.words(1, "").integer(2, kOpset)).bytes();
}

}  // namespace

Result<std::string> to_onnx(const TensorSet& set) { return OnnxGraph(set).model(); }

Result<void> save_onnx(const std::filesystem::path& path, const TensorSet& set) {
  const Result<std::string> bytes = to_onnx(set);
  if (!bytes) return fail(bytes.error());
  return write_file(path, *bytes);
}

}  // namespace mjarm::rl
