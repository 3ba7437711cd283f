#include "mjarm/serve/show_in_page.hpp"

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "mjarm/core/log.hpp"
#include "mjarm/core/messages.hpp"
#include "mjarm/core/messages/serve.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/os_random.hpp"
#include "mjarm/serve/first_view_internal.hpp"

namespace mjarm::serve {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kLook{20};  // between two looks whether it is over
constexpr std::size_t kTokenBytes = 16;

Result<std::string> token_of(const PageOptions& options) {
  if (options.token.empty()) return secret_hex(kTokenBytes);
  if (options.token.size() != 2 * kTokenBytes ||
      options.token.find_first_not_of("0123456789abcdef") != std::string::npos) {
    return fail(Errc::usage, text(msg::serve_bad_token, 2 * kTokenBytes));
  }
  return options.token;
}

void tell_address(const PageSite& site, const PageOptions& options) {
  if (!is_loopback(options.server.address)) {
    log_warning(text(msg::serve_not_alone, options.server.address));
  }
  if (options.on_open) options.on_open(site.url());
}

/// Until Ctrl-C, the end of the time, or `is_through`.
template <class IsThrough>
void wait_for_end(const PageOptions& options, const IsThrough& is_through) {
  const auto end = Clock::now() + std::chrono::duration<double>(options.seconds);
  while (!interrupted() && !is_through() && !(options.seconds > 0 && Clock::now() >= end)) {
    std::this_thread::sleep_for(kLook);
  }
}

/// Everything a page needs, as long as it is served.
class ServedScene {
 public:
  [[nodiscard]] static Result<std::unique_ptr<ServedScene>> create(
      const Model& model, const std::string& title, const view::WindowOptions& window,
      const PageOptions& options, view::ViewLink& link) {
    Result<render::CameraView> view = first_view(model, window.camera);
    if (!view) return fail(std::move(view.error()));
    Result<std::string> token = token_of(options);
    if (!token) return fail(std::move(token.error()));
    SceneFacts facts{.title = title,
                     .name = std::string(model.name()),
                     .language = language(),
                     .view = *view,
                     .nq = model.nq(),
                     .can_step = window.can_step,
                     .can_reset = window.can_reset,
                     .can_push = window.can_push,
                     .can_target = window.can_target && options.target != nullptr,
                     .can_lead = window.can_lead,
                     .turns = options.turns,
                     .jog_dofs = window.jog_dofs};
    std::unique_ptr<ServedScene> scene(
        new ServedScene(model, std::move(facts), std::move(*token), window, options, link));
    Result<PageServer> server = PageServer::start(scene->site_, &scene->feed_, options.server);
    if (!server) return fail(std::move(server.error()));
    scene->server_.emplace(std::move(*server));
    scene->tell(options);
    return scene;
  }
  [[nodiscard]] int pages() const { return server_->pages(); }
  void stop(const std::string& why) { server_->stop(why); }

 private:
  /// What a user wants to know about a server that runs.
  void tell(const PageOptions& options) const {
    if (!has_page_) log_warning(text(msg::serve_no_page));
    if (drawn_.left_out > 0) log_info(text(msg::serve_left_out, drawn_.left_out));
    tell_address(site_, options);
  }
  ServedScene(const Model& model, SceneFacts facts, std::string token,
              const view::WindowOptions& window, const PageOptions& options, view::ViewLink& link)
      : drawn_(drawn_model(model)),
        facts_(std::move(facts)),
        site_(std::move(token), options.server.address),
        feed_(model, drawn_, facts_, link, options.target, window.paused) {
    site_.add_scene(drawn_, facts_);
    has_page_ = site_.add_page(page_folder().value_or(""));
  }

  DrawnModel drawn_;
  SceneFacts facts_;
  PageSite site_;
  LiveFeed feed_;
  bool has_page_ = false;
  std::optional<PageServer> server_;  ///< last: it uses all of them
};

}  // namespace

Result<void> show_in_page(const Model& model, const std::string& title,
                          const view::WindowOptions& window, const PageOptions& options,
                          const std::function<void(view::ViewLink&)>& simulate) {
  view::ViewLink link;
  const auto served = ServedScene::create(model, title, window, options, link);
  if (!served) return fail(served.error());
  std::atomic<bool> is_through{false};
  std::thread worker([&] {
    simulate(link);
    is_through = true;
  });
  wait_for_end(options, [&is_through] { return is_through.load(); });
  link.closed = true;
  worker.join();
  (*served)->stop(text(msg::serve_over));
  return {};
}

Result<void> show_run_page(std::string html, const PageOptions& options) {
  Result<std::string> token = token_of(options);
  if (!token) return fail(std::move(token.error()));
  PageSite site(std::move(*token), options.server.address);
  site.add_run(std::move(html));
  Result<PageServer> server = PageServer::start(site, nullptr, options.server);
  if (!server) return fail(std::move(server.error()));
  tell_address(site, options);
  wait_for_end(options, [] { return false; });
  server->stop(text(msg::serve_over));
  return {};
}

view::Shower page_shower(const PageOptions& options) {
  return [options](const view::ShowOrder& order) -> Result<void> {
    const auto served =
        ServedScene::create(order.model, order.title, order.options, options, order.link);
    if (served && options.waits) {
      log_info(text(msg::serve_waits));
      while ((*served)->pages() == 0 && !order.ended()) std::this_thread::sleep_for(kLook);
    }
    order.opened(served ? Result<void>() : fail(served.error()));
    if (!served) return {};  // whoever asked was told
    while (!order.ended()) std::this_thread::sleep_for(kLook);
    (*served)->stop(text(msg::serve_over));
    return {};
  };
}

}  // namespace mjarm::serve
