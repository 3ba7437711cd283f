#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mjarm/model/drawn_model.hpp"
#include "mjarm/serve/scene_json.hpp"

namespace mjarm::serve {

/// What a request of HTTP asks for.
struct SiteRequest {
  std::string_view method = "GET";
  std::string_view target = {};                 ///< as in the first line
  std::string_view host = {};                   ///< header `Host`
  std::optional<std::string_view> origin = {};  ///< header `Origin`
  std::string_view if_none_match = {};          ///< header of that name
  bool upgrade = false;                         ///< asks for a WebSocket
};

/// What is answered.
struct SiteAnswer {
  int status = 200;
  std::vector<std::pair<std::string, std::string>> headers = {};  ///< all but Content-Length
  std::shared_ptr<const std::string> body = {};                   ///< never null
  bool is_live = false;  ///< the request may become a WebSocket
};

/// The folder of the page in the files that are shipped: the first `page` beside the models that
/// has an index.html; none where there is none.
[[nodiscard]] std::optional<std::filesystem::path> page_folder();

/// What a server has to give, and to whom: files by an exact list, below a folder whose name is
/// secret. Knows nothing of sockets. Constant once it is made, but for `set_port`.
class PageSite {
 public:
  /// @param token  name of the folder; 32 hexadecimal digits.
  /// @param address  on which it is served: for a loopback address a request has to name 127.0.0.1
  ///                 or localhost, else a number or localhost; no name that somebody else could
  ///                 lead here.
  PageSite(std::string token, std::string address);

  /// Adds index.html, page.js and page.css from `folder`, as far as they are there.
  /// @return false where index.html or page.js is not; then the site says so in its place.
  bool add_page(const std::filesystem::path& folder);
  /// Adds the page of a recorded run (`run_page`) as it is: what it may do it says itself.
  void add_run(std::string html);
  /// Adds scene.json and the meshes, and what lives: /live.
  void add_scene(const DrawnModel& model, const SceneFacts& facts);
  /// Where it listens, once that is known.
  void set_port(int port) noexcept { port_ = port; }

  [[nodiscard]] SiteAnswer answer(const SiteRequest& request) const;
  /// What is answered where a request cannot be read, or there are too many.
  [[nodiscard]] SiteAnswer refusal(int status) const;
  /// The address to be opened.
  [[nodiscard]] std::string url() const;

 private:
  struct File {
    std::shared_ptr<const std::string> body;
    std::string type;
    std::string etag;
    std::string cache;
    bool has_policy = false;  ///< of its own
  };
  void add(const std::string& path, std::string body, const char* type, const char* cache);
  [[nodiscard]] bool is_host(std::string_view host) const;
  [[nodiscard]] SiteAnswer answer_found(const SiteRequest& request, const File& file) const;
  [[nodiscard]] SiteAnswer say(int status, std::string_view line, std::string_view host) const;

  std::string token_;
  std::string address_;
  int port_ = 0;
  bool lives_ = false;
  std::map<std::string, File, std::less<>> files_;
};

/// Whether an address is one of this machine alone: 127.x.y.z or ::1.
[[nodiscard]] bool is_loopback(std::string_view address) noexcept;

}  // namespace mjarm::serve
