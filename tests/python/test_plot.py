"""What the pictures hold."""

import unittest

import matplotlib.pyplot as plt
import numpy as np
import wunderlich


class Plots(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.result = wunderlich.run("swing", {"solver.duration": 0.05, "ribbon.segments": 10})

    def tearDown(self):
        plt.close("all")

    def test_surface(self):
        surface = self.result.surface()
        axes = wunderlich.plot.surface(surface)
        drawn, = axes.collections
        axes.figure.canvas.draw()
        self.assertEqual(len(drawn.get_facecolor()), len(surface.triangles))
        self.assertEqual(len(axes.figure.axes), 1)
        colored = wunderlich.plot.surface(surface, color_by="kappa", axes=plt.figure().add_subplot(projection="3d"))
        self.assertEqual(colored.figure.axes[1].get_ylabel(), "kappa [1/m]")
        low, high = colored.get_xlim()
        self.assertLessEqual(low, surface.points[:, 0].min() + 1e-12)
        self.assertGreaterEqual(high, surface.points[:, 0].max() - 1e-12)

    def test_lines(self):
        axes = wunderlich.plot.profile(self.result.strip, 2)
        for line, values in zip(axes.lines, [self.result.strip.kappa, self.result.strip.tau, self.result.strip.eta], strict=True):
            np.testing.assert_array_equal(line.get_ydata(), values[2])
        same = plt.figure().add_subplot()
        self.assertIs(wunderlich.plot.energies(self.result.history, axes=same), same)
        np.testing.assert_array_equal(same.lines[-1].get_ydata(), self.result.history["total"])

    def test_what_is_no_picture(self):
        for wrong, draw in [("result.strip", wunderlich.plot.profile), ("result.history", wunderlich.plot.energies),
                            ("result.surface", wunderlich.plot.surface)]:
            with self.assertRaisesRegex(TypeError, f"{wrong}.*not a Result"):
                draw(self.result)
        with self.assertRaisesRegex(ValueError, "no 'zzz'; it has .*kappa"):
            wunderlich.plot.surface(self.result.surface(), color_by="zzz")

    def test_film(self):
        film = wunderlich.plot.film(self.result, color_by="kappa")
        axes = film._fig.axes[0]
        corners = []
        for frame in [0, len(self.result) - 1]:
            film._draw_frame(frame)
            drawn, = axes.collections
            corners.append(drawn._vec.copy())
        self.assertGreater(np.abs(corners[1] - corners[0]).max(), 1e-3)
        film._draw_was_started = True  # nobody has shown it, which matplotlib would warn of


if __name__ == "__main__":
    unittest.main(verbosity=2)
