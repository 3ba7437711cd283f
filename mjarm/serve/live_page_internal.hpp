#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>

#include "mjarm/serve/connection_internal.hpp"

namespace mjarm::serve {

/// Makes a page of a connection that asked for a WebSocket.
/// @param answer  its headers go along with the handshake.
void start_page(Hub& hub, boost::asio::ip::tcp::socket socket,
                const boost::beast::http::request<boost::beast::http::empty_body>& request,
                const SiteAnswer& answer);

}  // namespace mjarm::serve
