#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>

/// Short names for Boost.Asio and Boost.Beast.
namespace fleetmap::monitor {

namespace beast = boost::beast;
namespace http = beast::http;
namespace net = boost::asio;
using boost::system::error_code;
using net::ip::tcp;

using Request = http::request<http::empty_body>;
using Response = http::response<http::string_body>;

}  // namespace fleetmap::monitor
