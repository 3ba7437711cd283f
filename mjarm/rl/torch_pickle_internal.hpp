#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/result.hpp"

namespace mjarm::rl {

/// Where the numbers of a tensor lie, as torch pickles it. Nothing about it has been checked but
/// the types: sizes may be negative or larger than the storage.
struct PickledTensor {
  std::string storage;      ///< name of its numbers (float32) in the archive, e.g. "0"
  std::int64_t count = 0;   ///< numbers in the storage
  std::int64_t offset = 0;  ///< its first number
  std::vector<std::int64_t> shape;
  std::vector<std::int64_t> strides;  ///< as many, in numbers
};

/// Reads the pickle of a state_dict as `torch.save` writes it, protocol 2. This is no pickle
/// machine: it knows the instructions that a dictionary of float32 tensors needs and the globals
/// collections.OrderedDict, torch._utils._rebuild_tensor_v2 and torch.FloatStorage, of which it
/// keeps no more than the name. It imports and calls nothing, and its memory is bounded by the size
/// of the pickle.
/// Instructions: CPython, Lib/pickletools.py. Layout: torch/serialization.py, _save.
/// @param source  name of the file, for messages.
/// @return bad_input with one line that names the instruction or the global that is refused, or
///         where in the pickle it is damaged.
[[nodiscard]] Result<std::map<std::string, PickledTensor>> read_torch_pickle(
    std::string_view pickle, const std::string& source);

}  // namespace mjarm::rl
