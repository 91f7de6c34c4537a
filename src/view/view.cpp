#include "view/view.h"

#include <chrono>
#include <memory>
#include <thread>

#include "render/framing.h"
#include "view/token.h"

namespace troffer {

bool view(Scene scene, ViewSettings settings, const ViewStart& start, const StopFlag& stop) {
  const auto lighting = std::make_shared<Lighting>(std::move(scene));
  if (!start.has_camera) settings.camera = framing_camera(*lighting->whole(), settings.up);
  MeasureOptions measuring;
  measuring.method = settings.options.method;
  measuring.indirect = settings.options.indirect;
  measuring.error = settings.options.error;
  measuring.threads = settings.options.threads;
  measuring.seed = settings.options.seed;
  LayerBoard board;
  MeasuringQueue queue(measuring);
  Painter painter(board, settings.options);
  ViewService service(lighting, settings, board, painter, queue);
  HttpServer server(start.port, random_token(),
                    [&](const HttpRequest& request) { return service.answer(request); });
  if (start.note)
    for (const std::string& n : service.notes()) start.note(n);
  start.tell(server.address());
  constexpr std::chrono::milliseconds pause{20};
  while (!stop.load() && !service.is_closed()) {
    server.drop_slow_clients();
    std::this_thread::sleep_for(pause);
  }
  return !stop.load();
}

}  // namespace troffer
