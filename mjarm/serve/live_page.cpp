#include <array>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <cstdint>
#include <deque>
#include <utility>

#include "mjarm/core/messages/serve.hpp"
#include "mjarm/serve/live_messages.hpp"
#include "mjarm/serve/live_page_internal.hpp"

namespace mjarm::serve {
namespace {

constexpr int kSendBuffer = 64 * 1024;  // [bytes] the system keeps for a slow page
constexpr int kMaxRefused = 100;        // messages of a page; then it is dropped
constexpr int kMessagesATick = 64;      // of a page that are read

class Page final : public LivePage, public std::enable_shared_from_this<Page> {
 public:
  Page(Hub& hub, tcp::socket socket) : hub_(hub), counted_(hub), socket_(std::move(socket)) {
    ++hub_.page_count;
  }
  ~Page() override {
    hub_.feed->let_go(hold_);
    --hub_.page_count;
  }
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;

  void accept(const http::request<http::empty_body>& request, const SiteAnswer& answer) {
    beast::get_lowest_layer(socket_).expires_never();
    ErrorCode ignored;
    beast::get_lowest_layer(socket_).socket().set_option(
        net::socket_base::send_buffer_size(kSendBuffer), ignored);
    socket_.set_option(websocket::stream_base::timeout{clock_seconds(hub_.options.request_seconds),
                                                       clock_seconds(hub_.options.silent_seconds),
                                                       true});
    socket_.set_option(websocket::stream_base::decorator(
        [headers = answer.headers](websocket::response_type& response) {
          for (const auto& [name, value] : headers) {
            if (name != "Content-Type") response.set(name, value);
          }
        }));
    socket_.read_message_max(kMaxPageMessage);
    socket_.auto_fragment(false);  // else a long message goes out in pieces of 4 KiB
    socket_.async_accept(request, [self = shared_from_this()](ErrorCode error) {
      if (!error) self->begin();
    });
  }

  void tick() override {
    allowed_ = kMessagesATick;
    if (waits_) read();
    pump();
  }
  void say_bye(std::shared_ptr<const std::string> bye) override {
    bye_ = std::move(bye);
    pump();
  }
  void cut() override { beast::get_lowest_layer(socket_).close(); }

 private:
  void begin() {
    hub_.pages.insert(shared_from_this());
    own_.push_front(std::make_shared<const std::string>(hello_message()));
    hub_.refresh();
    read();
    pump();
  }

  void read() {
    // What a page sends waits in its own connection while the simulation has enough to read.
    waits_ = allowed_ <= 0 || !hub_.feed->has_room();
    if (waits_ || is_refused() || is_gone_) return;
    --allowed_;
    socket_.async_read(in_, [self = shared_from_this()](ErrorCode error, std::size_t) {
      error ? self->leave() : self->use();
    });
  }

  void use() {
    const auto bytes = in_.cdata();
    const std::string_view text_of_page(static_cast<const char*>(bytes.data()), bytes.size());
    const Result<void> done = socket_.got_text() ? hub_.feed->handle(text_of_page, hold_)
                                                 : fail(Errc::bad_input, text(msg::serve_binary));
    in_.consume(in_.size());
    if (!done) refuse(done.error().what);
    read();
  }

  void refuse(const std::string& what) {
    own_.push_back(std::make_shared<const std::string>(error_message(what)));
    ++refused_;
    pump();
  }

  /// The page is gone; what is still under way ends by itself.
  void leave() {
    hub_.pages.erase(shared_from_this());
    hub_.feed->let_go(hold_);
    is_gone_ = true;
    beast::get_lowest_layer(socket_).close();
  }

  /// The message to be sent next: its own first, then the kinds in turn, so that none waits for
  /// ever behind another that always changes.
  std::shared_ptr<const std::string> next(bool& is_text) {
    is_text = true;
    if (!own_.empty()) {
      std::shared_ptr<const std::string> bytes = std::move(own_.front());
      own_.pop_front();
      return bytes;
    }
    for (std::size_t i = 0; i < kLiveKinds && !is_refused(); ++i) {
      turn_ = (turn_ + 1) % kLiveKinds;
      const auto kind = static_cast<LiveKind>(turn_);
      const LiveMessage& message = hub_.feed->message(kind);
      if (message.version == sent_[turn_]) continue;
      sent_[turn_] = message.version;
      is_text = kind != LiveKind::frame;
      return message.bytes;
    }
    return std::exchange(bye_, nullptr);
  }

  void pump() {
    if (is_writing_ || is_gone_ || is_closing_) return;
    bool is_text = true;
    const bool is_last = bye_ != nullptr;
    out_ = next(is_text);
    if (!out_) {
      if (is_refused()) close(websocket::close_code::policy_error);
      return;
    }
    is_writing_ = true;
    const bool ends = is_last && bye_ == nullptr;
    socket_.text(is_text);
    socket_.async_write(net::buffer(*out_),
                        [self = shared_from_this(), ends](ErrorCode error, std::size_t) {
                          self->is_writing_ = false;
                          if (error) return self->leave();
                          ends ? self->close(websocket::close_code::going_away) : self->pump();
                        });
  }

  [[nodiscard]] bool is_refused() const { return refused_ >= kMaxRefused; }
  void close(websocket::close_code why) {
    if (std::exchange(is_closing_, true)) return;
    socket_.async_close(why, [self = shared_from_this()](ErrorCode) { self->leave(); });
  }

  Hub& hub_;
  Counted counted_;
  websocket::stream<beast::tcp_stream> socket_;
  beast::flat_buffer in_{kMaxPageMessage + 1024};
  std::deque<std::shared_ptr<const std::string>> own_ = {};  ///< hello and refusals: bounded
  std::shared_ptr<const std::string> bye_ = {};              ///< the last, when all else is sent
  std::shared_ptr<const std::string> out_ = {};              ///< under way
  std::array<std::uint64_t, kLiveKinds> sent_ = {};          ///< versions
  std::size_t turn_ = kLiveKinds - 1;
  PageHold hold_ = {};
  int refused_ = 0;
  int allowed_ = kMessagesATick;
  bool waits_ = false;  ///< is not read from until the next tick
  bool is_writing_ = false;
  bool is_gone_ = false;
  bool is_closing_ = false;
};

}  // namespace

void start_page(Hub& hub, tcp::socket socket, const http::request<http::empty_body>& request,
                const SiteAnswer& answer) {
  std::make_shared<Page>(hub, std::move(socket))->accept(request, answer);
}

}  // namespace mjarm::serve
