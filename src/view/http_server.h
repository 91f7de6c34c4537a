// Serves one page on this machine alone: the only user of libmicrohttpd.
//
// It listens on 127.0.0.1. All addresses begin with a token; without it every request fails. It
// also checks the Host header against DNS rebinding, and the Origin header against requests from
// other pages. Head (memory of a connection), body, number and duration of requests are limited. It
// serves no files: `Handle` produces every answer.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

namespace troffer {

// A request as `Handle` gets it.
struct HttpRequest {
  bool is_post = false;
  std::string path;                          // path after the token: "" or "state", …
  std::map<std::string, std::string> query;  // decoded; the last one of equal names
  std::string body;

  // Returns a value of the query; "" if it is missing.
  std::string value(const std::string& key) const {
    const auto at = query.find(key);
    return at == query.end() ? "" : at->second;
  }
};

// An answer.
struct HttpResponse {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string body;
  std::string file_name;  // name of the download; empty: shown in the page
};

// Limits on requests.
struct HttpLimits {
  size_t body_bytes = 1 << 20;
  size_t head_bytes = 32 << 10;  // memory of a connection, head included
  unsigned connections = 64;
  double request_seconds = 30;   // from the end of one request to the end of the next
  double response_seconds = 60;  // time for the client to receive an answer
};

// The server; it runs on a thread of its own.
class HttpServer {
 public:
  // Called from one thread. UsageError and InputError become status 400, other exceptions 500, with
  // their text.
  using Handle = std::function<HttpResponse(const HttpRequest&)>;

  // port 0: any free port. Throws EnvironmentError if the port is not available.
  HttpServer(uint16_t port, std::string token, Handle handle, const HttpLimits& limits = {});
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  uint16_t port() const;
  // "http://127.0.0.1:PORT/TOKEN/"
  std::string address() const;
  // Ends connections that exceed their time. Call it regularly.
  void drop_slow_clients();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace troffer
