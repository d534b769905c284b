"""How results look: trees and tables as text, HTML and pictures. Knows nothing of planning."""
