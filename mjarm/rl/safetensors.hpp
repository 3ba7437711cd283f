#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "mjarm/core/result.hpp"
#include "mjarm/rl/tensor_set.hpp"

/// The file format safetensors: a JSON header with names, types and shapes, then plain numbers. It
/// can hold nothing that is run. https://github.com/huggingface/safetensors, "Format"
namespace mjarm::rl {

/// The bytes of a safetensors file: the same for equal sets, and the same as the library writes
/// where there is at most one text about them.
/// @param source  name of the file, for messages.
/// @return an error where a name or a text is not UTF-8, a shape does not fit its values, or a
///         tensor is named "__metadata__".
[[nodiscard]] Result<std::string> to_safetensors(const TensorSet& set, const std::string& source);

/// Writes `set` to `path` in one step: either the whole new file stands there or the old state.
[[nodiscard]] Result<void> save_safetensors(const std::filesystem::path& path,
                                            const TensorSet& set);

/// The tensors in the bytes of a safetensors file (numbers of the types F32, F64 and I64).
/// @param source  name of the file, for messages.
/// @return bad_input with one line that names the file and the tensor where the header is
///         malformed, or where the tensors do not fill the data without gap and overlap.
[[nodiscard]] Result<TensorSet> parse_safetensors(std::string_view bytes,
                                                  const std::string& source);

/// Like `parse_safetensors`, of a file of at most 1 GiB.
[[nodiscard]] Result<TensorSet> load_safetensors(const std::filesystem::path& path);

}  // namespace mjarm::rl
