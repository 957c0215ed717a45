"""One software GL context for all render tests; every GL object has to be released after each."""

from collections.abc import Callable, Iterator

import moderngl
import numpy as np
import pytest

from stippler import headless
from stippler.camera import Camera
from stippler.drawing.dots import Dots
from stippler.render.frame import Frame
from stippler.render.renderer import Renderer
from stippler.render.state import release_target

WHITE, BLACK = (1.0, 1.0, 1.0), (0.0, 0.0, 0.0)
MAKERS = (
    "buffer", "texture", "renderbuffer", "depth_renderbuffer", "framebuffer", "program",
    "vertex_array",
)  # fmt: skip


@pytest.fixture(scope="session")
def context() -> Iterator[moderngl.Context]:
    ctx = headless.open_context()
    yield ctx
    ctx.release()


@pytest.fixture
def ctx(context: moderngl.Context, monkeypatch: pytest.MonkeyPatch) -> Iterator[moderngl.Context]:
    """Hand out the context, and fail if anything made in it is still alive afterwards."""
    made = []

    def watched(name: str) -> Callable:
        make = getattr(moderngl.Context, name)

        def wrapper(self, *args, **kwargs):
            made.append(make(self, *args, **kwargs))
            return made[-1]

        return wrapper

    for name in MAKERS:
        monkeypatch.setattr(moderngl.Context, name, watched(name))
    with context:  # tests of other files may have made contexts of their own since
        yield context
    assert made, "a test that takes a context and makes nothing in it"
    alive = [thing for thing in made if type(thing.mglo).__name__ != "InvalidObject"]
    assert not alive, f"not released: {alive}"
    assert context.error == "GL_NO_ERROR"


class Canvas:
    """A framebuffer to draw in and to read from."""

    def __init__(self, ctx: moderngl.Context, size: tuple[int, int]) -> None:
        self.size = size
        self._ctx = ctx
        self.framebuffer = ctx.framebuffer([ctx.texture(size, 3)])

    def pixels(self) -> np.ndarray:
        """Return (h, w, 3) uint8, the top row first."""
        data = self.framebuffer.read(components=3, alignment=1)
        return np.frombuffer(data, np.uint8).reshape(self.size[1], self.size[0], 3)[::-1]

    def release(self) -> None:
        release_target(self._ctx, self.framebuffer)


@pytest.fixture
def canvas(ctx: moderngl.Context) -> Iterator[Callable[[tuple[int, int]], Canvas]]:
    made: list[Canvas] = []

    def make(size: tuple[int, int]) -> Canvas:
        made.append(Canvas(ctx, size))
        return made[-1]

    yield make
    for one in made:
        one.release()


@pytest.fixture
def renderer(ctx: moderngl.Context) -> Iterator[Renderer]:
    one = Renderer(ctx)
    yield one
    one.release()


@pytest.fixture
def ink(renderer: Renderer, canvas: Callable) -> Callable[..., np.ndarray]:
    """Draw black on white and return the ink of each pixel, 0 to 1."""

    def drawn(camera: Camera, size: tuple[int, int], **shown) -> np.ndarray:
        target = canvas(size)
        frame = Frame(camera, size, paper=WHITE, desk=WHITE, ink=BLACK, marks=None, **shown)
        renderer.draw(frame, target.framebuffer)
        return 1.0 - target.pixels()[:, :, 0] / 255.0

    return drawn


@pytest.fixture
def shaped() -> Callable[..., Dots]:
    """Make dots of any shape."""

    def make(position, radius, *, elongation=1.0, angle=0.0, roughness=0.0, seed=None) -> Dots:
        dots = Dots.round(position, radius)
        dots.elongation[:], dots.angle_rad[:], dots.roughness[:] = elongation, angle, roughness
        if seed is not None:
            dots.seed[:] = seed
        return dots

    return make


@pytest.fixture
def many(shaped: Callable) -> Callable[..., Dots]:
    """Make dots of all shapes on a jittered grid on a page of 40 by 30 mm; none touch."""

    def make(n_x: int = 20, n_y: int = 15, kind: str = "rough", seed: int = 3) -> Dots:
        rng = np.random.default_rng(seed)
        step = np.array([40.0 / n_x, 30.0 / n_y])
        grid = np.stack(np.meshgrid(np.arange(n_x), np.arange(n_y)), -1).reshape(-1, 2) + 0.5
        position = (grid + rng.uniform(-0.12, 0.12, grid.shape)) * step
        n = len(grid)
        radius = rng.uniform(0.09, 0.15, n) * step.min()
        dots = shaped(position, radius, seed=rng.integers(0, 2**32, n, np.uint32))
        if kind != "round":
            dots.elongation[:] = rng.uniform(1, 4, n)
            dots.angle_rad[:] = rng.uniform(-4, 4, n)
        if kind == "rough":
            dots.roughness[:] = rng.uniform(0, 1, n)
        return dots

    return make
