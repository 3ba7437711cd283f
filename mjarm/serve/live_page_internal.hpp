#pragma once

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include "mjarm/serve/connection_internal.hpp"

namespace mjarm::serve {

namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;

/// Makes a page of a connection that asked for a WebSocket.
/// @param answer  its headers go along with the handshake.
void start_page(Hub& hub, tcp::socket socket, const http::request<http::empty_body>& request,
                const SiteAnswer& answer);

}  // namespace mjarm::serve
