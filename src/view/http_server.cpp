#include "view/http_server.h"

#include <arpa/inet.h>
#include <microhttpd.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <strings.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string_view>

#include "base/error.h"
#include "view/token.h"

namespace troffer {

namespace {

using Clock = std::chrono::steady_clock;

// A request in progress.
struct Exchange {
  HttpRequest request;
  bool is_refused = false;
};

// State of a connection.
struct Connection {
  int socket = -1;
  Clock::time_point since;
  bool is_answered = false;  // the request is complete, the answer is being sent
};

std::string_view header(MHD_Connection* c, const char* name) {
  const char* value = MHD_lookup_connection_value(c, MHD_HEADER_KIND, name);
  return value != nullptr ? value : "";
}

MHD_Result add_argument(void* into, MHD_ValueKind, const char* name, const char* value) {
  (*static_cast<std::map<std::string, std::string>*>(into))[name] = value != nullptr ? value : "";
  return MHD_YES;
}

MHD_Result send(MHD_Connection* c, const HttpResponse& r) {
  // libmicrohttpd copies the body and does not write to it.
  MHD_Response* response = MHD_create_response_from_buffer(
      r.body.size(), const_cast<char*>(r.body.data()), MHD_RESPMEM_MUST_COPY);
  if (response == nullptr) return MHD_NO;
  const auto add = [&](const char* name, const std::string& value) {
    MHD_add_response_header(response, name, value.c_str());
  };
  add("Content-Type", r.type);
  add("Cache-Control", "no-store");
  add("X-Content-Type-Options", "nosniff");
  add("Referrer-Policy", "no-referrer");
  if (r.status == 405) add("Allow", "GET, HEAD, POST");
  add("Cross-Origin-Resource-Policy", "same-origin");
  add("Content-Security-Policy",
      "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
      "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
  if (!r.file_name.empty())
    add("Content-Disposition", "attachment; filename=\"" + r.file_name + "\"");
  const MHD_Result result = MHD_queue_response(c, unsigned(r.status), response);
  MHD_destroy_response(response);
  return result;
}

// Refuses an address with too many arguments and ends the connection. libmicrohttpd stores
// arguments in the connection's memory before any callback runs. If that memory is full, it cannot
// report it and would wait for the timeout.
void refuse_many_arguments(MHD_Connection* c, std::string_view uri) {
  constexpr std::ptrdiff_t most_arguments = 64;
  if (std::count(uri.begin(), uri.end(), '&') < most_arguments) return;
  const MHD_ConnectionInfo* info = MHD_get_connection_info(c, MHD_CONNECTION_INFO_CONNECTION_FD);
  if (info == nullptr) return;
  constexpr std::string_view answer =
      "HTTP/1.1 414 URI Too Long\r\nConnection: close\r\nContent-Type: text/plain\r\n"
      "Content-Length: 19\r\n\r\ntoo many arguments\n";
  [[maybe_unused]] const ssize_t sent =
      ::send(info->connect_fd, answer.data(), answer.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  shutdown(info->connect_fd, SHUT_RDWR);
}

// True if the headers state the length of the body more than once.
bool has_two_lengths(MHD_Connection* c) {
  int lengths = 0;
  const auto count = [](void* into, MHD_ValueKind, const char* name, const char*) {
    if (strcasecmp(name, MHD_HTTP_HEADER_CONTENT_LENGTH) == 0 ||
        strcasecmp(name, MHD_HTTP_HEADER_TRANSFER_ENCODING) == 0)
      ++*static_cast<int*>(into);
    return MHD_YES;
  };
  MHD_get_connection_values(c, MHD_HEADER_KIND, count, &lengths);
  return lengths > 1;
}

HttpResponse refusal(int status, const char* text) {
  return {status, "text/plain; charset=utf-8", std::string(text) + "\n", ""};
}

}  // namespace

struct HttpServer::Parts {
  std::string token;
  Handle handle;
  HttpLimits limits;
  MHD_Daemon* daemon = nullptr;
  uint16_t port = 0;
  std::mutex mutex;
  std::map<MHD_Connection*, Connection> connections;

  // Checks the head of a request and sets its path. Returns status 200, or a refusal.
  HttpResponse check(MHD_Connection* c, const char* url, std::string_view method,
                     Exchange& e) const;
  bool is_own_host(std::string_view host) const;
  void note(MHD_Connection* c, bool is_answered);
  MHD_Result answer(MHD_Connection* c, Exchange& e);
  MHD_Result take(MHD_Connection* c, const char* url, const char* method, const char* data,
                  size_t* size, void** exchange);
};

namespace {

// Keeps exceptions from passing through C code.
template <class Act>
MHD_Result guarded(const Act& act) {
  try {
    return act();
  } catch (...) {  // out of memory: the connection ends
    return MHD_NO;
  }
}

}  // namespace

bool HttpServer::Parts::is_own_host(std::string_view host) const {
  const std::string at = ":" + std::to_string(port);
  return host == "127.0.0.1" + at || host == "localhost" + at;
}

HttpResponse HttpServer::Parts::check(MHD_Connection* c, const char* url, std::string_view method,
                                      Exchange& e) const {
  if (!is_own_host(header(c, MHD_HTTP_HEADER_HOST))) return refusal(403, "not this host");
  const std::string_view origin = header(c, "Origin");
  constexpr std::string_view scheme = "http://";
  if (!origin.empty() &&
      (!origin.starts_with(scheme) || !is_own_host(origin.substr(scheme.size()))))
    return refusal(403, "not from this page");
  const std::string_view path = url;
  const size_t end = path.find('/', 1);
  // Without the token all addresses look alike, even one that lacks only its final slash.
  if (path.empty() || path[0] != '/' || end == path.npos ||
      !is_same_token(path.substr(1, end - 1), token))
    return refusal(404, "nothing here");
  e.request.is_post = method == MHD_HTTP_METHOD_POST;
  // libmicrohttpd answers HEAD with the headers of GET.
  if (!e.request.is_post && method != MHD_HTTP_METHOD_GET && method != MHD_HTTP_METHOD_HEAD)
    return refusal(405, "GET, HEAD or POST");
  if (has_two_lengths(c)) return refusal(400, "the length is given twice");
  const std::string_view length = header(c, MHD_HTTP_HEADER_CONTENT_LENGTH);
  if (!length.empty() && std::strtoull(length.data(), nullptr, 10) > limits.body_bytes)
    return refusal(413, "too large");
  e.request.path = path.substr(end + 1);
  return {};
}

void HttpServer::Parts::note(MHD_Connection* c, bool is_answered) {
  const std::lock_guard lock(mutex);
  const auto at = connections.find(c);
  if (at == connections.end()) return;
  at->second.since = Clock::now();
  at->second.is_answered = is_answered;
}

MHD_Result HttpServer::Parts::answer(MHD_Connection* c, Exchange& e) {
  HttpResponse response;
  try {
    response = handle(e.request);
  } catch (const UsageError& error) {
    response = refusal(400, error.what());
  } catch (const InputError& error) {
    response = refusal(400, error.what());
  } catch (const std::exception& error) {
    response = refusal(500, error.what());
  }
  note(c, true);
  return send(c, response);
}

// Called for the head of a request, for every piece of its body, and at its end.
MHD_Result HttpServer::Parts::take(MHD_Connection* c, const char* url, const char* method,
                                   const char* data, size_t* size, void** exchange) {
  if (*exchange == nullptr) {
    auto e = std::make_unique<Exchange>();
    const HttpResponse refused = check(c, url, method, *e);
    e->is_refused = refused.status != 200;
    Exchange* const held = e.release();  // freed in on_completed
    *exchange = held;
    if (held->is_refused) return send(c, refused);
    MHD_get_connection_values(c, MHD_GET_ARGUMENT_KIND, add_argument, &held->request.query);
    return MHD_YES;
  }
  Exchange& e = *static_cast<Exchange*>(*exchange);
  if (*size == 0) return e.is_refused ? MHD_NO : answer(c, e);
  // The body may come without a stated length.
  if (e.request.body.size() + *size > limits.body_bytes) return MHD_NO;
  e.request.body.append(data, *size);
  *size = 0;
  return MHD_YES;
}

HttpServer::HttpServer(uint16_t port, std::string token, Handle handle, const HttpLimits& limits)
    : parts_(std::make_unique<Parts>()) {
  Parts& p = *parts_;
  p.token = std::move(token);
  p.handle = std::move(handle);
  p.limits = limits;
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const MHD_AccessHandlerCallback on_request = [](void* self, MHD_Connection* c, const char* url,
                                                  const char* method, const char*, const char* data,
                                                  size_t* size, void** exchange) {
    return guarded(
        [&] { return static_cast<Parts*>(self)->take(c, url, method, data, size, exchange); });
  };
  const MHD_RequestCompletedCallback on_completed =
      [](void* self, MHD_Connection* c, void** exchange, MHD_RequestTerminationCode) {
        delete static_cast<Exchange*>(*exchange);
        *exchange = nullptr;
        static_cast<Parts*>(self)->note(c, false);
      };
  const MHD_NotifyConnectionCallback on_connection = [](void* self, MHD_Connection* c, void**,
                                                        MHD_ConnectionNotificationCode code) {
    Parts& parts = *static_cast<Parts*>(self);
    const std::lock_guard lock(parts.mutex);
    if (code != MHD_CONNECTION_NOTIFY_STARTED) {
      parts.connections.erase(c);
      return;
    }
    const MHD_ConnectionInfo* info = MHD_get_connection_info(c, MHD_CONNECTION_INFO_CONNECTION_FD);
    if (info != nullptr) parts.connections[c] = {info->connect_fd, Clock::now(), false};
  };
  using TakeAddress = void* (*)(void*, const char*, MHD_Connection*);
  const TakeAddress on_address = [](void*, const char* uri, MHD_Connection* c) -> void* {
    refuse_many_arguments(c, uri);
    return nullptr;  // no exchange yet
  };
  constexpr unsigned idle_seconds = 20;
  p.daemon = MHD_start_daemon(
      MHD_USE_INTERNAL_POLLING_THREAD | MHD_USE_AUTO, port, nullptr, nullptr, on_request, &p,
      MHD_OPTION_SOCK_ADDR, &address, MHD_OPTION_CONNECTION_LIMIT, limits.connections,
      MHD_OPTION_CONNECTION_MEMORY_LIMIT, limits.head_bytes, MHD_OPTION_CONNECTION_TIMEOUT,
      idle_seconds, MHD_OPTION_NOTIFY_COMPLETED, on_completed, &p, MHD_OPTION_NOTIFY_CONNECTION,
      on_connection, &p, MHD_OPTION_URI_LOG_CALLBACK, on_address, nullptr,
      MHD_OPTION_STRICT_FOR_CLIENT, 1, MHD_OPTION_END);
  if (p.daemon == nullptr)
    throw EnvironmentError("cannot listen on 127.0.0.1" +
                           (port > 0 ? ":" + std::to_string(port) : "") + ": " +
                           std::strerror(errno));
  p.port = MHD_get_daemon_info(p.daemon, MHD_DAEMON_INFO_BIND_PORT)->port;
}

HttpServer::~HttpServer() {
  MHD_stop_daemon(parts_->daemon);
}

uint16_t HttpServer::port() const {
  return parts_->port;
}

std::string HttpServer::address() const {
  return "http://127.0.0.1:" + std::to_string(parts_->port) + "/" + parts_->token + "/";
}

void HttpServer::drop_slow_clients() {
  Parts& p = *parts_;
  const std::lock_guard lock(p.mutex);  // sockets of listed connections are open
  for (auto& [connection, c] : p.connections) {
    const std::chrono::duration<double> taken = Clock::now() - c.since;
    if (taken.count() > (c.is_answered ? p.limits.response_seconds : p.limits.request_seconds))
      shutdown(c.socket, SHUT_RDWR);
  }
}

}  // namespace troffer
