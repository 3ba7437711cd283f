#include "mjarm/core/share.hpp"

#include "mjarm/core/os.hpp"

namespace mjarm {

Result<std::filesystem::path> share_folder() {
  const Result<std::filesystem::path> self = executable_path();
  if (!self) return fail(self.error());
  return (self->parent_path() / ".." / "share" / "mjarm").lexically_normal();
}

}  // namespace mjarm
