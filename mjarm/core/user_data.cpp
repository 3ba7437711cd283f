#include "mjarm/core/user_data.hpp"

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/os.hpp"

namespace mjarm {

Result<std::filesystem::path> data_folder() {
  if (const auto data = user_folder("XDG_DATA_HOME", ".local/share")) return *data / "mjarm";
  return fail(Errc::system, text(msg::core_no_data_folder));
}

}  // namespace mjarm
