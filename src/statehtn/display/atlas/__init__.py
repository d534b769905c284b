"""The page that shows an atlas."""
