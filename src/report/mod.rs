//! What people look at: overlays, plots, the HTML page.
