// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/raycast/moving_scene.h"

#include <mutex>
#include <utility>
#include <vector>

#include "artus/detail/soft/solver/deformed_body.h"

namespace artus {

namespace {

std::shared_ptr<const BodyMap> map_of(const Scene& scene) {
  return scene.tissue() ? indexed(scene.tissue()->mapped()).map : nullptr;
}

}  // namespace

/// Scenes that nobody holds, all of one index. Those of another are let go of when they come back.
struct MovingScene::Pool {
  std::mutex mutex;
  std::shared_ptr<const BodyMap> map;
  std::vector<std::unique_ptr<Scene>> free;
  std::shared_ptr<const IndexedSurfaces> surfaces;  // of the map; null until there is one

  std::unique_ptr<Scene> take(const std::shared_ptr<const BodyMap>& wanted) {
    const std::lock_guard<std::mutex> lock(mutex);
    if (map != wanted) {
      map = wanted;
      free.clear();
      surfaces = nullptr;
    }
    if (free.empty()) return nullptr;
    std::unique_ptr<Scene> scene = std::move(free.back());
    free.pop_back();
    return scene;
  }

  [[nodiscard]] std::shared_ptr<const IndexedSurfaces> surfaces_of(
      const std::shared_ptr<const BodyMap>& wanted) {
    const std::lock_guard<std::mutex> lock(mutex);
    return map == wanted ? surfaces : nullptr;
  }

  void keep(const std::shared_ptr<const BodyMap>& of,
            std::shared_ptr<const IndexedSurfaces> shared) {
    const std::lock_guard<std::mutex> lock(mutex);
    if (map != of) free.clear();
    map = of;
    surfaces = std::move(shared);
  }

  void add(const std::shared_ptr<const BodyMap>& of, std::unique_ptr<Scene> scene) {
    const std::lock_guard<std::mutex> lock(mutex);
    if (of && of == map) free.push_back(std::move(scene));
  }

  void give_back(std::unique_ptr<Scene> scene) {
    const std::shared_ptr<const BodyMap> of = map_of(*scene);
    scene->move(nullptr);
    add(of, std::move(scene));
  }
};

MovingScene::MovingScene(SceneOptions options)
    : options_(std::move(options)), pool_(std::make_shared<Pool>()) {}

std::shared_ptr<const Scene> MovingScene::at(std::shared_ptr<const DeformedBody> tissue) {
  ARTUS_REQUIRE(tissue != nullptr, "a body is needed");
  const std::shared_ptr<const BodyMap> map = indexed(tissue->mapped()).map;
  std::unique_ptr<Scene> scene = pool_->take(map);
  if (!scene) {
    // NOLINTNEXTLINE(*-owning-memory): the constructor is private
    scene.reset(new Scene(*tissue, options_, pool_->surfaces_of(map)));
    pool_->keep(map, scene->surfaces());
  }
  scene->move(std::move(tissue));
  return {scene.release(), [pool = pool_](Scene* left) {
            pool->give_back(std::unique_ptr<Scene>(left));
          }};
}

std::vector<std::shared_ptr<const Scene>> MovingScene::make_ready(
    const std::shared_ptr<const DeformedBody>& tissue, std::size_t count) {
  std::vector<std::shared_ptr<const Scene>> ready;
  while (ready.size() < count) ready.push_back(at(tissue));
  return ready;
}

void MovingScene::make_ahead(const std::shared_ptr<const DeformedBody>& tissue,
                             std::size_t count) const {
  ARTUS_REQUIRE(tissue != nullptr, "a body is needed");
  const std::shared_ptr<const BodyMap> map = indexed(tissue->mapped()).map;
  const std::shared_ptr<const IndexedSurfaces> surfaces = pool_->surfaces_of(map);
  for (std::size_t k = 0; surfaces && k < count; ++k)
    // NOLINTNEXTLINE(*-owning-memory): the constructor is private
    pool_->add(map, std::unique_ptr<Scene>(new Scene(*tissue, options_, surfaces)));
}

void MovingScene::share(const Scene& other) {
  const std::shared_ptr<const BodyMap> map = map_of(other);
  if (map) pool_->keep(map, other.surfaces());
}

std::shared_ptr<const Scene> make_scene(std::shared_ptr<const DeformedBody> tissue) {
  return MovingScene().at(std::move(tissue));
}

}  // namespace artus
