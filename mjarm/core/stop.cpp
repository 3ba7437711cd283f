#include "mjarm/core/stop.hpp"

#include "mjarm/core/messages/run.hpp"

namespace mjarm {

Error stopped() { return {Errc::system, text(msg::run_interrupted)}; }

}  // namespace mjarm
