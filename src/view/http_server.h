// A server for one page, on this machine alone: the only user of libmicrohttpd.
//
// It listens on 127.0.0.1 and answers who knows the token, which all addresses begin with, and asks
// for this very host: a page from elsewhere whose name has been made to lead here (DNS rebinding)
// gets nothing, nor does one that sends requests across (Origin). Requests have bounds: their head
// (the memory of a connection), their body, their number at a time, and the time that they take.
// It serves no files: what it answers is what `Handle` makes of a name.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

namespace troffer {

struct HttpRequest {
  bool is_post = false;
  std::string path;                          // behind the token: "" or "state" …
  std::map<std::string, std::string> query;  // decoded; of equal names the last
  std::string body;
};

struct HttpResponse {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string body;
  std::string file_name;  // to be saved as; empty: to be shown
};

struct HttpLimits {
  size_t body_bytes = 1 << 20;
  size_t head_bytes = 32 << 10;  // and what else a connection needs
  unsigned connections = 64;
  double request_seconds = 30;   // from the end of one request to that of the next
  double response_seconds = 60;  // to take an answer
};

class HttpServer {
 public:
  // Is called from one thread. UsageError and InputError become status 400, what else it throws
  // 500, with their text.
  using Handle = std::function<HttpResponse(const HttpRequest&)>;

  // port 0: any that is free. Throws EnvironmentError where it is not to be had.
  HttpServer(uint16_t port, std::string token, Handle handle, const HttpLimits& limits = {});
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  uint16_t port() const;
  // "http://127.0.0.1:PORT/TOKEN/"
  std::string address() const;
  // Ends connections that have taken too long; to be called again and again.
  void drop_slow_clients();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace troffer
