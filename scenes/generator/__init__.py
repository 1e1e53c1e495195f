"""The generator of Tenebra's bundled scenes: a glTF writer, shapes, motion, and one module for each scene."""
