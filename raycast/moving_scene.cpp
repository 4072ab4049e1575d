// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/raycast/moving_scene.h"

#include <mutex>
#include <utility>
#include <vector>

#include "artus/soft/deformed_body.h"

namespace artus {

/// Scenes that nobody holds, all of one index. Those of another are let go of when they come back.
struct MovingScene::Pool {
  std::mutex mutex;
  std::shared_ptr<const BodyMap> map;
  std::vector<std::unique_ptr<Scene>> free;

  std::unique_ptr<Scene> take(const std::shared_ptr<const BodyMap>& wanted) {
    const std::lock_guard<std::mutex> lock(mutex);
    if (map != wanted) {
      map = wanted;
      free.clear();
    }
    if (free.empty()) return nullptr;
    std::unique_ptr<Scene> scene = std::move(free.back());
    free.pop_back();
    return scene;
  }

  void give_back(std::unique_ptr<Scene> scene) {
    const std::shared_ptr<const DeformedBody> tissue = scene->tissue();
    scene->move(nullptr);
    const std::lock_guard<std::mutex> lock(mutex);
    if (tissue && indexed(tissue->mapped()).map == map) free.push_back(std::move(scene));
  }
};

MovingScene::MovingScene(SceneOptions options)
    : options_(std::move(options)), pool_(std::make_shared<Pool>()) {}

std::shared_ptr<const Scene> MovingScene::at(std::shared_ptr<const DeformedBody> tissue) {
  ARTUS_REQUIRE(tissue != nullptr, "a body is needed");
  std::unique_ptr<Scene> scene = pool_->take(indexed(tissue->mapped()).map);
  if (!scene) scene.reset(new Scene(*tissue, options_));  // NOLINT(*-owning-memory): private
  scene->move(std::move(tissue));
  return {scene.release(), [pool = pool_](Scene* left) {
            pool->give_back(std::unique_ptr<Scene>(left));
          }};
}

std::shared_ptr<const Scene> make_scene(std::shared_ptr<const DeformedBody> tissue) {
  return MovingScene().at(std::move(tissue));
}

}  // namespace artus
